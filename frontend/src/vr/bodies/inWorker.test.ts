import { MessageChannel } from "node:worker_threads";
import { loadMujoco } from "@shared/avatar/mujoco";
import { describe, expect, it } from "vitest";
import type { Bodies } from "./bodies";
import { openBodiesInPage } from "./inPage";
import { BodiesInWorker } from "./inWorker";
import { goalsAt } from "./testing/movement";
import { physicsSetup } from "./testing/person";
import type { BodiesPort } from "./worker/messages";
import { serveBodies, type WorkerPort } from "./worker/service";

const FRAME_S = 1 / 90;

/** A worker's port in this thread; frames go by messages, as without shared memory. */
function localPort(): BodiesPort {
  const { port1, port2 } = new MessageChannel();
  serveBodies(port2 as unknown as WorkerPort, () => loadMujoco());
  const close = () => port1.close();
  return Object.assign(port1, { terminate: close }) as unknown as BodiesPort;
}

async function stepped(bodies: Bodies, frame: number): Promise<void> {
  bodies.step({ timeS: frame * FRAME_S, goals: goalsAt(frame * FRAME_S), fingers: null });
  if (bodies instanceof BodiesInWorker) await bodies.idle();
}

describe("bodies behind messages", () => {
  it("are those of the page, one frame later", async () => {
    const page = await openBodiesInPage(physicsSetup());
    const worker = await BodiesInWorker.open(
      localPort(),
      physicsSetup(),
      new ArrayBuffer(8),
      false,
    );
    for (const bodies of [page, worker]) bodies.showSurfaces(["front", "left", "right"]);
    for (let frame = 0; frame < 40; frame++) {
      await stepped(worker, frame);
      const shown = worker.latest();
      if (frame === 0) expect(shown).toBeNull();
      else {
        expect(shown?.timeS).toBe((frame - 1) * FRAME_S);
        expect([...(shown?.remote ?? [])]).toEqual([...(page.latest()?.remote ?? [])]);
        expect([...(shown?.touched ?? [])]).toEqual([...(page.latest()?.touched ?? [])]);
        expect(shown?.health).toEqual(page.latest()?.health);
      }
      await stepped(page, frame);
    }
    expect(worker.addedS).toBeCloseTo(FRAME_S, 12);
    expect(page.addedS).toBe(0);
    for (const bodies of [page, worker]) bodies.dispose();
  });
});
