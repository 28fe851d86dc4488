/** What the benchmarks of the browser's avatar share: bundling `shared/avatar`, and its goals. */
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

/** Calls `use(bundled)`, where `bundled(name)` imports a module of `shared/avatar` of `frontend`. */
export async function withBundles(frontend, use) {
  const require = createRequire(join(frontend, "package.json"));
  const { rolldown } = await import(pathToFileURL(require.resolve("rolldown")).href);
  const folder = mkdtempSync(join(frontend, "node_modules", ".avatar-"));
  try {
    await use(async (name) => {
      const bundle = await rolldown({
        input: join(frontend, "src/shared/avatar", `${name}.ts`),
        external: /^@mujoco\//,
      });
      const { output } = await bundle.generate({ format: "esm" });
      const file = join(folder, `${name}.mjs`);
      writeFileSync(file, output[0].code);
      return import(pathToFileURL(file).href);
    });
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** The goals of a frame of the vectors, by body part; null where a part is not tracked. */
export function goalsOf(frame, parts, waist) {
  const places = parts.map((part, row) => {
    const seen = frame.tracked[row] && (row > 0 || waist);
    const place = { positionM: frame.positions_m[row], rotation: frame.rotations[row] };
    return [part, seen ? place : null];
  });
  return Object.fromEntries(places);
}
