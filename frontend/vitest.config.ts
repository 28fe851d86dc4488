import { defineConfig, mergeConfig } from "vitest/config";
import vite from "./vite.config.ts";

// Apart from the build's own configuration, since building the pages installs no test runner.
export default mergeConfig(
  vite,
  defineConfig({
    test: {
      // What builds the pages stands beside `src`, which is the root.
      include: ["**/*.test.ts", "**/*.test.tsx", "../*.test.ts"],
      environment: "node",
      // Files share modules, which halves the time: a test leaves nothing behind that another sees.
      isolate: false,
      // A slow machine must pass: the limit is there for tests that never end.
      testTimeout: 120_000,
    },
  }),
);
