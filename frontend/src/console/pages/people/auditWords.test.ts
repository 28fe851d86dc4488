/** Check that every action that the server records has a sentence without open placeholders. */
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import type { AuditEntry } from "@shared/api/people";
import { createTranslations } from "@shared/i18n/i18n";
import { describe, expect, it } from "vitest";
import { trackersDe, trackersEn } from "../trackers/texts";
import { auditDe, auditEn } from "./auditTexts";
import { actorName, KINDS, sentences } from "./auditWords";
import { peopleDe, peopleEn } from "./texts";

const tables = createTranslations(
  {
    en: { ...auditEn, ...peopleEn, ...trackersEn },
    de: { ...auditDe, ...peopleDe, ...trackersDe },
  },
  "en",
);
const t = (key: string, values?: Readonly<Record<string, string | number>>) =>
  tables.t(key, { ...values });

const entry = (action: string, details: AuditEntry["details"] = {}, subject = ""): AuditEntry => ({
  seq: 1,
  at: "2026-01-01T12:00:00Z",
  actor: "account:ada",
  action,
  subject,
  details,
  hash: "",
});

const FEATURES = join(import.meta.dirname, "../../../../../app/features");
const files = readdirSync(FEATURES, { recursive: true, encoding: "utf8" }).filter((name) =>
  name.endsWith(".py"),
);
const JOB_ENDINGS = ["ordered", "stopped", "resumed", "removed"] as const;
const ACTIONS = files.flatMap((name) => {
  const source = readFileSync(join(FEATURES, name), "utf8");
  const named = source.matchAll(/action="([a-z]+\.[a-z_]+)"|caller, "(study\.[a-z]+)"/g);
  const actions = [...named].map(([, one, two]) => one ?? two ?? "");
  // A kind of job names what is done with it; the four things that can be done follow its name.
  return source.includes("= JobKind(")
    ? actions.flatMap((one) => JOB_ENDINGS.map((ending) => `${one}_${ending}`))
    : actions;
});

describe("the audit trail in words", () => {
  it("finds the actions in the server's source", () => {
    expect(ACTIONS).toContain("login.revoked");
    expect(ACTIONS).toContain("study.archived");
  });

  it.each(ACTIONS)("has words for %s", (action) => {
    const [first] = sentences(entry(action, {}, "study:one"), t);
    expect(first).not.toContain(action);
    expect(KINDS.some((kind) => action.startsWith(`${kind}.`))).toBe(true);
  });

  it("gives the number of sign-ins that an entry stands for", () => {
    expect(sentences(entry("login.refused", { address: "10.0.0.1", count: 59 }), t)).toEqual([
      "59 more sign-ins from 10.0.0.1 were refused",
    ]);
  });

  it("describes every change of one action", () => {
    const changed = entry(
      "account.changed",
      { role: "analyst", studies: ["a", "b"] },
      "account:bo",
    );
    expect(sentences(changed, t)).toEqual([
      "gave bo the role Analyst",
      "limited bo to these studies: a, b",
    ]);
  });

  it("gives the number of sign-ins that were ended", () => {
    const revoked = entry("login.revoked", { ended: 2 }, "account:bo");
    expect(sentences(revoked, t)).toEqual(["ended 2 sign-ins of bo"]);
  });

  it("shows unknown actions as they are recorded", () => {
    const strange = entry("moon.landed", { at_m: 3 }, "moon:one");
    expect(sentences(strange, t)).toEqual(["moon.landed one", "at m: 3"]);
  });

  it("names people by their user name", () => {
    expect([actorName("account:ada"), actorName("nobody"), actorName("tablet:x")]).toEqual([
      "ada",
      "nobody",
      "tablet",
    ]);
  });

  it("names a door as its page does", () => {
    const opened = { door: "json", interface: "127.0.0.1", port: 39570 };
    expect(sentences(entry("tracker.opened", opened), t)).toEqual([
      "opened the door Scripts for trackers, on 127.0.0.1, port 39570",
    ]);
  });
});
