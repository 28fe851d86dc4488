import { describe, expect, it } from "vitest";
import { type Clocked, installVirtualClock } from "./virtualClock";

function page(): Clocked & { performance: { now(): number } } {
  return {
    requestAnimationFrame: () => 0,
    cancelAnimationFrame: () => undefined,
    performance: { now: () => 1000 },
  };
}

describe("The virtual clock", () => {
  it("draws a frame only when it is stepped, a frame's time after the last", () => {
    const of = page();
    const clock = installVirtualClock({ frameRateHz: 100 }, of);
    const seen: number[] = [];
    const loop = (timeMs: number) => {
      seen.push(timeMs);
      of.requestAnimationFrame(loop);
    };
    of.requestAnimationFrame(loop);
    expect(seen).toEqual([]);
    clock.step();
    clock.step();
    expect(seen).toEqual([1010, 1020]);
    expect(of.performance.now()).toBe(1020);
    expect(clock.realNowMs()).toBe(1000);
  });

  it("lets time pass without frames while the device sleeps", () => {
    const of = page();
    const clock = installVirtualClock({}, of);
    let frames = 0;
    of.requestAnimationFrame(() => {
      frames++;
    });
    clock.sleep(3);
    expect([frames, of.performance.now()]).toEqual([0, 4000]);
  });

  it("runs every callback of a frame although one throws, and gives the page its clock back", () => {
    const of = page();
    const { requestAnimationFrame } = of;
    const clock = installVirtualClock({}, of);
    let ran = false;
    of.requestAnimationFrame(() => {
      throw new Error("broken");
    });
    const cancelled = of.requestAnimationFrame(() => {
      throw new Error("was cancelled");
    });
    of.cancelAnimationFrame(cancelled);
    of.requestAnimationFrame(() => {
      ran = true;
    });
    expect(() => clock.step()).toThrow("broken");
    expect(ran).toBe(true);
    clock.uninstall();
    expect(of.performance.now()).toBe(1000);
    expect(of.requestAnimationFrame).toBe(requestAnimationFrame);
  });
});
