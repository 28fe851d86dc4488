import { describe, expect, it } from "vitest";
import type { AvatarFile } from "./axes";
import { changesIn, keepDraft, keptDrafts as offeredTo, slotOf, startOf } from "./keptDrafts";

const file = (total_mass_kg: number) =>
  ({ format: "reembody-avatar", version: 1, total_mass_kg, axes: {} }) as unknown as AvatarFile;
const draft = (mass: number, at: string, by = "anna") => ({
  by,
  baseHash: "a",
  configuration: file(mass),
  at,
});
const keptDrafts = (storage: Storage, avatarKey: string, own: string) =>
  offeredTo(storage, avatarKey, own, "anna");

/** The part of a browser's storage that drafts use; it is full beyond `limit` entries. */
function storageOf(limit = 100): Storage {
  const entries = new Map<string, string>();
  return {
    get length() {
      return entries.size;
    },
    key: (index: number) => [...entries.keys()][index] ?? null,
    getItem: (key: string) => entries.get(key) ?? null,
    setItem: (key: string, text: string) => {
      if (entries.size >= limit && !entries.has(key)) throw new Error("full");
      entries.set(key, text);
    },
    removeItem: (key: string) => void entries.delete(key),
    clear: () => entries.clear(),
  };
}

describe("unsaved work on an avatar", () => {
  it("of two tabs is kept side by side, and both are offered, newest first", () => {
    const storage = storageOf();
    const [first, second, later] = ["1", "2", "3"].map((id) => slotOf("soft", id));
    keepDraft(storage, first ?? "", draft(80, "2026-05-04T09:00:00Z"));
    keepDraft(storage, second ?? "", draft(90, "2026-05-04T10:00:00Z"));
    const offered = keptDrafts(storage, "soft", later ?? "");
    expect(offered.map(({ slot }) => slot)).toEqual([second, first]);
    expect(offered.map(({ at }) => at?.slice(11, 13))).toEqual(["10", "09"]);
    expect(offered.map((one) => changesIn(one, file(80)))).toEqual([1, 0]);
  });

  it("beside an offer leaves what is offered as it was", () => {
    const storage = storageOf();
    keepDraft(storage, slotOf("soft", "earlier"), draft(80, "2026-05-04T09:00:00Z"));
    const own = slotOf("soft", "now");
    const before = keptDrafts(storage, "soft", own);
    keepDraft(storage, own, draft(95, "2026-05-04T11:00:00Z"));
    expect(keptDrafts(storage, "soft", own)).toEqual(before);
    expect(keptDrafts(storage, "soft", slotOf("soft", "next"))).toHaveLength(2);
  });

  it("of an avatar is not offered for another whose key begins alike", () => {
    const storage = storageOf();
    keepDraft(storage, slotOf("soft-2", "1"), draft(80, "2026-05-04T09:00:00Z"));
    expect(keptDrafts(storage, "soft", "")).toEqual([]);
  });

  it("of an earlier release is offered, and so is what cannot be read", () => {
    const storage = storageOf();
    storage.setItem("reembody.draft.avatar.soft", JSON.stringify({ configuration: file(75) }));
    storage.setItem(slotOf("soft", "cut"), '{"configuration": {"axes"');
    storage.setItem(slotOf("soft", "odd"), '{"configuration": {"axes": null}, "at": 5}');
    const offered = keptDrafts(storage, "soft", "");
    expect(offered.map((one) => changesIn(one, file(72)))).toEqual([1, null, null]);
    expect(offered[1]?.text).toBe('{"configuration": {"axes"');
  });

  it("is reported as not kept where the storage is full", () => {
    const kept = keepDraft(storageOf(0), slotOf("soft", "1"), draft(80, "2026-05-04T09:00:00Z"));
    expect(kept).toBe(false);
  });

  it("is offered to the person who made it, and to nobody else", () => {
    const storage = storageOf();
    keepDraft(storage, slotOf("soft", "1"), draft(80, "2026-05-04T09:00:00Z", "ben"));
    expect(offeredTo(storage, "soft", "", "anna")).toEqual([]);
    expect(offeredTo(storage, "soft", "", "ben")).toHaveLength(1);
  });

  it("is offered without a time where what is stored is no time", () => {
    const storage = storageOf();
    for (const at of ["xx", "", "2026-13-45"]) {
      keepDraft(storage, slotOf("soft", `at ${at}`), draft(80, at));
    }
    expect(keptDrafts(storage, "soft", "").map(({ at }) => at)).toEqual([null, null, null]);
  });

  it("goes on from the version that it began from, though others were saved since", () => {
    const storage = storageOf();
    keepDraft(storage, slotOf("soft", "1"), draft(80, "2026-05-04T09:00:00Z"));
    const [kept] = keptDrafts(storage, "soft", "");
    const versions = [
      { number: 4, content_hash: "d" },
      { number: 3, content_hash: "a" },
      { number: 1, content_hash: "a" },
    ];
    expect(kept && startOf(kept, versions)).toBe(3);
    expect(kept && startOf(kept, versions.slice(0, 1))).toBeNull();
  });
});
