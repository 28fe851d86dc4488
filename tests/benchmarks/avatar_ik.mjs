/**
 * Times the browser's inverse kinematics under Node: `node avatar_ik.mjs FRONTEND VECTORS ROUNDS`.
 *
 * Bundles `shared/avatar` in memory, follows the frames of the vectors there and back again so many
 * times, and prints the times of single frames in microseconds as JSON: {name: [times]}.
 */
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { goalsOf, withBundles } from "./avatar_bundles.mjs";

const [, , frontend, vectors, rounds] = process.argv;
await withBundles(frontend, async (bundled) => {
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
});
