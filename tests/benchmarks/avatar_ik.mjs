/**
 * Times the browser's inverse kinematics under Node: `node avatar_ik.mjs FRONTEND VECTORS ROUNDS`.
 *
 * Bundles `shared/avatar` in memory, follows the frames of the vectors there and back again so many
 * times, and prints the times of single frames in microseconds as JSON: {name: [times]}.
 */
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [, , frontend, vectors, rounds] = process.argv;
const require = createRequire(join(frontend, "package.json"));
const { rolldown } = await import(pathToFileURL(require.resolve("rolldown")).href);
const folder = mkdtempSync(join(frontend, "node_modules", ".avatar-ik-"));

async function bundled(name) {
  const bundle = await rolldown({
    input: join(frontend, "src/shared/avatar", `${name}.ts`),
    external: /^@mujoco\//,
  });
  const { output } = await bundle.generate({ format: "esm" });
  const file = join(folder, `${name}.mjs`);
  writeFileSync(file, output[0].code);
  return import(pathToFileURL(file).href);
}

function goalsOf(frame, parts, waist) {
  const places = parts.map((part, row) => {
    const seen = frame.tracked[row] && (row > 0 || waist);
    const place = { positionM: frame.positions_m[row], rotation: frame.rotations[row] };
    return [part, seen ? place : null];
  });
  return Object.fromEntries(places);
}

try {
  const { InverseKinematics } = await bundled("ik");
  const { loadMujoco, modelFrom } = await bundled("mujoco");
  const mujoco = await loadMujoco();
  const model = modelFrom(mujoco, readFileSync(join(vectors, "body.xml"), "utf8"));
  const { frames, parts, cases } = JSON.parse(readFileSync(join(vectors, "ik.json"), "utf8"));
  const times = {};
  for (const { name, waist } of cases) {
    const goals = frames.map((frame) => goalsOf(frame, parts, waist));
    const way = [...goals, ...goals.toReversed()];
    const solver = new InverseKinematics(mujoco, model);
    times[name] = [];
    for (let round = -1; round < Number(rounds); round++) {
      for (const goal of way) {
        const began = performance.now();
        solver.solve(goal);
        if (round >= 0) times[name].push(1000 * (performance.now() - began));
      }
    }
    solver.delete();
  }
  console.log(JSON.stringify(times));
} finally {
  rmSync(folder, { recursive: true });
}
