/** Tests of sizes, forecasts and shares as they are displayed. */
import type { StorageRoom } from "@shared/api/housekeeping";
import { bytes } from "@shared/format";
import { describe, expect, it } from "vitest";
import { diskShares, roundToTwoDigits } from "../storage/figures";

describe("sizes", () => {
  it.each([
    [0, "0 B"],
    [999, "999 B"],
    [1000, "1 kB"],
    [1234, "1.23 kB"],
    [82_400_000, "82.4 MB"],
    [999_600_000, "1 GB"],
    [41_693_605_888, "41.7 GB"],
    [5e15, "5,000 TB"],
  ])("%d bytes are written %s", (size, words) => {
    expect(bytes(size, "en")).toBe(words);
  });

  it("use the language's own notation", () => {
    expect(bytes(1_250_000_000, "de")).toBe("1,25 GB");
  });
});

describe("a forecast", () => {
  it.each([
    [0, 0],
    [7, 7],
    [99, 99],
    [128, 120],
    [2757, 2700],
    [123_456, 120_000],
  ])("of %d sessions promises %d, never more", (count, promised) => {
    expect(roundToTwoDigits(count)).toBe(promised);
  });
});

describe("the disk", () => {
  const room = (disk: Partial<StorageRoom["disk"]>): StorageRoom =>
    ({
      disk: { free_bytes: 60, total_bytes: 100, holds_database: true, ...disk },
      parts: [
        { place: "samples", bytes: 25 },
        { place: "backups", bytes: 5 },
      ],
    }) as unknown as StorageRoom;

  it("is filled by three parts", () => {
    expect(diskShares(room({}))).toEqual({ own: 30, other: 10, free: 60, total: 100 });
  });

  it("contains no tables of a database elsewhere", () => {
    expect(diskShares(room({ holds_database: false }))).toMatchObject({ own: 5, other: 35 });
  });

  it("never shows more used by this server than is used", () => {
    expect(diskShares(room({ free_bytes: 90 }))).toMatchObject({ own: 10, other: 0 });
  });
});
