import { describe, expect, it } from "vitest";
import { Sharpness } from "./graphics";

function noted(sharpness: Sharpness, frameMs: number, frames: number): Sharpness {
  for (let at = 0; at < frames; at += 1) sharpness.note(frameMs);
  return sharpness;
}

describe("Sharpness", () => {
  it("stays as fine as at rest on a machine that draws every frame", () => {
    expect(noted(new Sharpness(2), 16.7, 1000).moving).toBe(2);
  });

  it("becomes coarser while frames are late, down to the coarsest", () => {
    const sharpness = noted(new Sharpness(1), 80, 20);
    expect(sharpness.moving).toBeLessThan(1);
    expect(noted(sharpness, 80, 1000).moving).toBe(0.4);
  });

  it("is not changed by one late frame", () => {
    const sharpness = noted(new Sharpness(1), 16.7, 10);
    expect(noted(noted(sharpness, 60, 1), 16.7, 10).moving).toBe(1);
  });

  it("becomes finer again where frames come in time, never finer than at rest", () => {
    const sharpness = noted(noted(new Sharpness(1), 80, 100), 16.7, 500);
    expect(sharpness.moving).toBeGreaterThan(0.4);
    expect(noted(sharpness, 16.7, 5000).moving).toBe(1);
  });
});
