import { describe, expect, it } from "vitest";
import {
  centimetresFromMetres,
  metres,
  metresFromCentimetres,
  milliseconds,
  millisecondsFromSeconds,
  type Seconds,
  seconds,
  secondsFromMilliseconds,
} from "./units";

describe("units", () => {
  it("convert there and back to the same value", () => {
    expect(millisecondsFromSeconds(secondsFromMilliseconds(milliseconds(125)))).toBe(125);
    expect(centimetresFromMetres(metresFromCentimetres(176.5))).toBeCloseTo(176.5, 12);
    expect(metresFromCentimetres(178)).toBe(metres(1.78));
  });

  it("do not compile where another unit is expected", () => {
    const wait = (time: Seconds): number => time;
    // @ts-expect-error milliseconds are not seconds
    expect(wait(milliseconds(5))).toBe(5);
    // @ts-expect-error a bare number has no unit
    expect(wait(5)).toBe(5);
    expect(wait(seconds(5))).toBe(5);
  });
});
