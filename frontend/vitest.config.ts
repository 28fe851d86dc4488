import { defineConfig, mergeConfig } from "vitest/config";
import vite from "./vite.config.ts";

// Separate from the build's configuration, because a build of the pages installs no test runner.
export default mergeConfig(
  vite,
  defineConfig({
    test: {
      // The build files are next to `src`, which is the root.
      include: ["**/*.test.ts", "**/*.test.tsx", "../*.test.ts"],
      environment: "node",
      // Files share modules, which halves the time, so tests must not leave state behind.
      isolate: false,
      // Slow machines must pass: the limit is only for tests that never end.
      testTimeout: 120_000,
    },
  }),
);
