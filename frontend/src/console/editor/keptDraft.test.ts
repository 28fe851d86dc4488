import { beforeEach, describe, expect, it, vi } from "vitest";
import { dropDraft, keptDraft, NEW_STUDY, storeDraft } from "./keptDraft";

const MORNING = new Date("2026-05-04T09:00:00Z");
const NOON = new Date("2026-05-04T12:00:00Z");

describe("an unsaved draft", () => {
  const entries = new Map<string, string>();
  beforeEach(() => {
    entries.clear();
    vi.stubGlobal("localStorage", {
      getItem: (key: string) => entries.get(key) ?? null,
      setItem: (key: string, text: string) => void entries.set(key, text),
      removeItem: (key: string) => void entries.delete(key),
    });
  });

  it("is kept with the time of its last change, until it is dropped", () => {
    storeDraft(NEW_STUDY, "key: mine\n", MORNING);
    expect(keptDraft(NEW_STUDY)).toEqual({
      text: "key: mine\n",
      changedAt: MORNING.toISOString(),
    });
    dropDraft(NEW_STUDY);
    expect(keptDraft(NEW_STUDY)).toBeNull();
  });

  it("that is only opened again does not look changed", () => {
    storeDraft(NEW_STUDY, "key: mine\n", MORNING);
    storeDraft(NEW_STUDY, "key: mine\n", NOON);
    expect(keptDraft(NEW_STUDY)?.changedAt).toBe(MORNING.toISOString());
    storeDraft(NEW_STUDY, "key: other\n", NOON);
    expect(keptDraft(NEW_STUDY)?.changedAt).toBe(NOON.toISOString());
  });

  it("of an earlier release is read, without a time", () => {
    entries.set("reembody.draft.new", "key: mine\n");
    expect(keptDraft(NEW_STUDY)).toEqual({ text: "key: mine\n", changedAt: null });
  });
});
