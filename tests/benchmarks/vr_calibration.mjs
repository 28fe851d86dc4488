/**
 * Calibrates scripted people under Node: `node vr_calibration.mjs FRONTEND PEOPLE`, a JSON
 * file with a list of them; prints what was measured of each as JSON.
 *
 * Bundles `vr/testing/calibrationBench.ts` of the pages; MuJoCo runs as in the headset.
 */
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [, , frontend, people] = process.argv;
const require = createRequire(join(frontend, "package.json"));
const { rolldown } = await import(pathToFileURL(require.resolve("rolldown")).href);
const folder = mkdtempSync(join(frontend, "node_modules", ".calibration-"));
try {
  const bundle = await rolldown({
    input: join(frontend, "src/vr/testing/calibrationBench.ts"),
    external: /^@mujoco\//,
    resolve: { alias: { "@shared": join(frontend, "src/shared") } },
  });
  const { output } = await bundle.generate({ format: "esm", codeSplitting: false });
  const file = join(folder, "bench.mjs");
  writeFileSync(file, output[0].code);
  const { calibrateAll } = await import(pathToFileURL(file).href);
  const found = await calibrateAll(JSON.parse(readFileSync(people, "utf8")));
  process.stdout.write(JSON.stringify(found));
} finally {
  rmSync(folder, { recursive: true });
}
