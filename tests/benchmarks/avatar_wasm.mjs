/**
 * What the browser's MuJoCo and inverse kinematics give: `node avatar_wasm.mjs FRONTEND VECTORS`.
 *
 * Bundles `shared/avatar` in memory, goes through the vectors' commands and goals, and prints as
 * JSON: `qpos` and `ncon` after every sample, and of each case `angles_rad`, `hips_m`, `hips`.
 */
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { goalsOf, withBundles } from "./avatar_bundles.mjs";

const [, , frontend, vectors] = process.argv;
const read = (name) => JSON.parse(readFileSync(join(vectors, `${name}.json`), "utf8"));

function simulated(mujoco, model, { key_s, sample_s, targets_rad, hips_m }) {
  const data = new mujoco.MjData(model);
  const perKey = Math.round(key_s / model.opt.timestep);
  const perSample = Math.round(sample_s / model.opt.timestep);
  const samples = [];
  for (let step = 0; step < perKey * (targets_rad.length - 1); step++) {
    const key = Math.floor(step / perKey);
    const fraction = (step % perKey) / perKey;
    const blend = fraction * fraction * (3 - 2 * fraction);
    const speed = (6 * fraction * (1 - fraction)) / key_s;
    const ctrl = data.ctrl;
    targets_rad[key].forEach((from, axis) => {
      const change = targets_rad[key + 1][axis] - from;
      ctrl[2 * axis] = from + blend * change;
      ctrl[2 * axis + 1] = speed * change;
    });
    const mocap = data.mocap_pos;
    hips_m[key].forEach((from, axis) => {
      mocap[axis] = from + blend * (hips_m[key + 1][axis] - from);
    });
    mujoco.mj_step(model, data);
    if ((step + 1) % perSample === 0) samples.push({ ncon: data.ncon, qpos: [...data.qpos] });
  }
  data.delete();
  return samples;
}

await withBundles(frontend, async (bundled) => {
  const { InverseKinematics } = await bundled("ik");
  const { loadMujoco, modelFrom } = await bundled("mujoco");
  const mujoco = await loadMujoco();
  const model = modelFrom(mujoco, readFileSync(join(vectors, "body.xml"), "utf8"));
  const samples = simulated(mujoco, model, read("trajectory"));
  const { frames, parts, cases } = read("ik");
  const solved = cases.map(({ waist }) => {
    const solver = new InverseKinematics(mujoco, model);
    const found = frames.map((frame) =>
      structuredClone(solver.solve(goalsOf(frame, parts, waist))),
    );
    const rows = {
      angles_rad: found.map((one) => [...one.anglesRad]),
      hips_m: found.map((one) => [...one.hips.positionM]),
      hips: found.map((one) => [...one.hips.rotation]),
    };
    solver.delete();
    return rows;
  });
  console.log(JSON.stringify({ samples, cases: solved }));
});
