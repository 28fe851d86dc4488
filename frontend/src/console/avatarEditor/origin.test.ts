import { describe, expect, it } from "vitest";
import { copiedFrom } from "./origin";

const listed = (key: string, content_hashes: readonly string[]) =>
  ({ key, title: key, content_hashes, newest: { origin: "by_hand" } }) as never;
const version = (number: number, content_hash: string, origin = "by_hand") =>
  ({ number, content_hash, origin }) as never;

describe("an avatar that repeats another's version", () => {
  const all = [listed("standard", ["a", "b"]), listed("mine", ["b", "c"])];

  it("is a copy of it, until something is changed", () => {
    expect(copiedFrom(version(1, "b"), "mine", all)).toMatchObject({ key: "standard" });
    expect(copiedFrom(version(1, "d"), "mine", all)).toBeNull();
    expect(copiedFrom(version(2, "c"), "mine", all)).toBeNull();
  });

  it("is none if it came with the product", () => {
    expect(copiedFrom(version(1, "b", "shipped"), "other", all)).toBeNull();
  });
});
