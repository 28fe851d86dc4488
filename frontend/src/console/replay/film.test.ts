import { expect, test } from "vitest";
import { endingOf, filmLayout } from "./film";

test("two stages stand beside each other, as high as the film, in their own proportions", () => {
  const { width, height, places } = filmLayout([1, 0.5]);
  expect(places).toEqual([
    { left: 0, width: 720 },
    { left: 720, width: 360 },
  ]);
  expect(width).toBe(1080);
  expect(height).toBe(760);
});

test("a wide pair is made smaller, and its size is even, as encoders need", () => {
  const { width, height, places } = filmLayout([16 / 9, 16 / 9 + 0.01]);
  expect(width).toBeLessThanOrEqual(1920);
  expect(width % 2).toBe(0);
  expect(height % 2).toBe(0);
  const last = places.at(-1);
  expect((last?.left ?? 0) + (last?.width ?? 0)).toBeCloseTo(1920);
});

test("the file is named after what the browser writes", () => {
  expect(endingOf("video/webm;codecs=vp9")).toBe("webm");
  expect(endingOf("video/mp4")).toBe("mp4");
});
