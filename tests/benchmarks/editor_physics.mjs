/**
 * The physics of the try-out, without a page: `node editor_physics.mjs FRONTEND BODY SECONDS`.
 *
 * BODY is a file with the models and configurations of two bodies: one to drive, one to push. Prints as JSON, for one body and for two: the
 * simulated time, the processor time that it took, and what failed; and for pushes of a shin how far
 * it gave way and how long it took to return.
 */
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [, , frontend, bodyFile, seconds] = process.argv;
const { body, plain } = JSON.parse(readFileSync(bodyFile, "utf8"));
const TICKS_A_PICTURE = 2;
const TICK_S = 0.01;
const AXIS = "LeftUpperArmZ";
const SHIN = "LeftLowerLeg";
const WAVE = { kind: "sine", centerRad: -0.4, amplitudeRad: 0.35, periodS: 1 };

/** As in the page: a joint swings, and every second a part is pushed or a box falls. */
function run(tryout, ticks) {
  tryout.obey({ kind: "drive", drive: { axis: AXIS, wave: WAVE } });
  for (let tick = 0; tick < ticks; tick += TICKS_A_PICTURE) {
    if (tick % 200 === 0) tryout.obey({ kind: "push", push: push(100) });
    if (tick % 200 === 100) tryout.obey({ kind: "drop", centerM: [0.1, 2.4, 0.05] });
    tryout.advance(TICKS_A_PICTURE, AXIS);
  }
}

/** At the shin's centre of mass, from the front. */
const push = (forceN) => ({ part: SHIN, pointM: null, forceN: [0, 0, forceN], forS: 0.2 });
/** The left thigh raised by 30 degrees, the knee bent by 50. */
const RAISED = { LeftUpperLegX: Math.PI / 6, LeftLowerLegX: (5 * Math.PI) / 18 };

function measured(Tryout, mujoco, count) {
  const tryout = new Tryout(mujoco, Array(count).fill(body));
  run(tryout, 200);
  const before = process.cpuUsage();
  const ticks = Math.round(Number(seconds) / TICK_S);
  run(tryout, ticks);
  const { user, system } = process.cpuUsage(before);
  const progress = tryout.advance(1, AXIS);
  const simulated_s = ticks * TICK_S;
  const failures = progress.reduce((sum, one) => sum + one.restored + one.resets, 0);
  const not_finite = progress.filter((one) => !one.isFinite).length;
  tryout.dispose();
  return { simulated_s, cpu_s: (user + system) / 1e6, failures, not_finite };
}

/** What the page tells of a push of the shin, once it has been watched. */
function pushed(Tryout, mujoco, forceN) {
  const tryout = new Tryout(mujoco, [plain]);
  tryout.obey({ kind: "pose", anglesRad: RAISED });
  tryout.obey({ kind: "reset" });
  tryout.advance(100, AXIS);
  tryout.obey({ kind: "push", push: push(forceN) });
  const [{ push: found }] = tryout.advance(300, AXIS);
  tryout.dispose();
  if (found.returnS === null) throw new Error(`The shin did not return from ${forceN} N.`);
  const greatest_deg = (found.peakRad * 180) / Math.PI;
  return { force_n: forceN, greatest_deg, returned_s: found.returnS };
}

const require = createRequire(join(frontend, "package.json"));
const { rolldown } = await import(pathToFileURL(require.resolve("rolldown")).href);
const folder = mkdtempSync(join(frontend, "node_modules", ".tryout-"));
try {
  const bundled = async (path) => {
    const bundle = await rolldown({
      input: join(frontend, "src", path),
      external: /^@mujoco\//,
      resolve: { alias: { "@shared": join(frontend, "src/shared") } },
    });
    const { output } = await bundle.generate({ format: "esm" });
    const file = join(folder, `${path.replaceAll("/", "-")}.mjs`);
    writeFileSync(file, output[0].code);
    return import(pathToFileURL(file).href);
  };
  const { Tryout } = await bundled("console/avatarEditor/tryout/physics/tryout.ts");
  const { loadMujoco } = await bundled("shared/avatar/mujoco.ts");
  const mujoco = await loadMujoco();
  console.log(
    JSON.stringify({
      alone: measured(Tryout, mujoco, 1),
      side_by_side: measured(Tryout, mujoco, 2),
      pushes: [50, 100, 200].map((forceN) => pushed(Tryout, mujoco, forceN)),
    }),
  );
} finally {
  rmSync(folder, { recursive: true });
}
