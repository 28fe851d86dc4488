import type { Alarm, LiveAlarm, SessionView, StorageNews, TelemetryNews } from "@shared/api/types";
import { registryEn } from "@shared/session/registries.generated";
import { milliseconds } from "@shared/units";
import { describe, expect, it } from "vitest";
import { en as pages } from "../../i18n/en";
import { at, session } from "../example";
import { TelemetryStore } from "../session/telemetryStore";
import {
  amount,
  currentAlarms,
  fromRecord,
  groupsOf,
  jointNames,
  mostUrgent,
  remedyKey,
  titleKey,
} from "./alarms";

const en = { ...pages, ...registryEn };
const warning = (code: string) => ({
  code,
  severity: "warning" as const,
  stream: null,
  message: code,
  value: null,
  unit: null,
});
const live = (code: string, more: Partial<LiveAlarm> = {}): LiveAlarm => ({
  ...warning(code),
  joints: [],
  since: "2026-03-02T09:30:00+00:00",
  ...more,
});

const recorded = (code: string, more: Partial<Alarm> = {}): Alarm => ({
  ...warning(code),
  id: code,
  client_t_s: null,
  since: "2026-03-02T09:30:00Z",
  cleared_at: null,
  outcome: null,
  ...more,
});

const quality = (alarms: readonly LiveAlarm[]) => ({ signal: null, alarms, at: milliseconds(0) });
const shown = (alarm: LiveAlarm, view: SessionView = session) => {
  const [only] = currentAlarms(view, quality([alarm]), null, milliseconds(0));
  if (only === undefined) throw new Error("nothing is shown");
  return only;
};

describe("the active alarms", () => {
  it("are listed with the critical ones first, then the newest", () => {
    const alarms = [
      live("gap", { since: "2026-03-02T09:30:05Z" }),
      live("jump"),
      live("clock_uncertain", { severity: "info", since: "2026-03-02T09:00:00Z" }),
      live("silent", { severity: "critical", since: "2026-03-02T09:31:00Z" }),
    ];
    const codes = currentAlarms(session, quality(alarms), null, milliseconds(10)).map(
      ({ code }) => code,
    );
    expect(codes).toEqual(["silent", "gap", "jump", "clock_uncertain"]);
  });

  it("come from the headset's messages while these are recent, otherwise from the session", () => {
    const view = { ...session, alarms: [recorded("disconnected")] };
    const message = quality([live("gap")]);
    const codes = (now: number, from: typeof message | null) =>
      currentAlarms(view, from, null, milliseconds(now)).map(({ code }) => code);
    expect(codes(2900, message)).toEqual(["gap"]);
    expect(codes(3100, message)).toEqual(["disconnected"]);
    expect(codes(0, null)).toEqual(["disconnected"]);
  });

  it("include the participant's calls, whatever the headset reports meanwhile", () => {
    for (const code of ["help_asked", "question_asked", "consent_refused", "stop_rule_met"]) {
      const view = { ...session, alarms: [recorded(code, { severity: "critical" })] };
      const codes = currentAlarms(view, quality([live("gap")]), null, milliseconds(10)).map(
        (alarm) => alarm.code,
      );
      expect(codes).toEqual([code, "gap"]);
    }
  });

  it("have the same key, whichever source reported them", () => {
    const view = { ...session, alarms: [recorded("gap", { stream: "target" })] };
    const [shown] = currentAlarms(session, quality([live("gap", { stream: "target" })]), null, at0);
    const [read] = currentAlarms(view, null, null, at0);
    expect(shown?.key).toBe(read?.key);
  });

  it("include the server's own, which neither the headset nor the record can report", () => {
    const codes = (news: Partial<StorageNews>) => {
      const message = {
        status: "ok",
        since: null,
        reason: null,
        low_disk: false,
        ...news,
      } as const;
      const storage = { news: message, receivedAt: "2026-03-02T09:30:00Z" };
      return currentAlarms(session, quality([live("gap")]), storage, at0).map(({ code }) => code);
    };
    expect(codes({})).toEqual(["gap"]);
    expect(codes({ status: "failing", low_disk: true })).toEqual(["storage", "gap"]);
    expect(codes({ low_disk: true })).toContain("low_disk");
  });
});

describe("the alarm that is shown", () => {
  const on = currentAlarms(
    session,
    quality([
      live("gap"),
      live("jump", { since: "2026-03-02T09:30:05Z" }),
      live("silent", { severity: "critical" }),
    ]),
    null,
    milliseconds(0),
  );

  it("is a critical one as long as it is active, acknowledged or not", () => {
    expect(mostUrgent(on, () => false)?.code).toBe("silent");
    expect(mostUrgent(on, ({ code }) => code === "silent")?.code).toBe("silent");
  });

  it("is one that is not acknowledged, among those of the same severity", () => {
    const warnings = on.filter(({ severity }) => severity === "warning");
    expect(mostUrgent(warnings, () => false)?.code).toBe("jump");
    expect(mostUrgent(warnings, ({ code }) => code === "jump")?.code).toBe("gap");
    expect(mostUrgent(warnings, () => true)?.code).toBe("jump");
    expect(mostUrgent([], () => false)).toBeUndefined();
  });
});

const at0 = milliseconds(0);

describe("the texts of an alarm", () => {
  it("exist for every code, including unknown ones", () => {
    const codes = ["question_asked", "consent_refused", "refusal_retracted"];
    for (const code of ["silent", "gap", "clock_unknown", ...codes, "of a later version"]) {
      const alarm = shown(live(code));
      expect(en[titleKey(alarm) as keyof typeof en]).toBeTruthy();
      expect(en[remedyKey(alarm, session) as keyof typeof en]).toBeTruthy();
    }
    expect(titleKey(shown(live("of a later version")))).toBe("alarm.other");
  });

  it("say that the phase is paused while it is", () => {
    const silent = shown(live("silent", { severity: "critical" }));
    const paused = { ...session, current: at(2, { status: "paused" }) };
    expect(remedyKey(silent, paused)).toBe("alarm.silent.paused");
    expect(remedyKey(silent, session)).toBe("alarm.silent.do");
    expect(remedyKey(shown(live("gap")), paused)).toBe("alarm.gap.do");
  });

  it("are one with a count where the same one came again, and as long as all of them", () => {
    const from = (code: string, second: number, more: Partial<Alarm> = {}) =>
      recorded(code, {
        id: `${code} ${second}`,
        since: `2026-03-02T09:30:0${second}Z`,
        cleared_at: `2026-03-02T09:30:0${second + 1}Z`,
        stream: "target",
        ...more,
      });
    const groups = groupsOf([
      from("gap", 8, { cleared_at: null }),
      from("jump", 7),
      from("gap", 5),
      from("gap", 4, { stream: "actual" }),
      from("gap", 1),
    ]);
    expect(
      groups.map(({ newest, count, since, lasted }) => [newest.id, count, since, lasted]),
    ).toEqual([
      ["gap 8", 3, "2026-03-02T09:30:01Z", 2],
      ["jump 7", 1, "2026-03-02T09:30:07Z", 1],
      ["gap 4", 1, "2026-03-02T09:30:04Z", 1],
    ]);
  });

  it("give the amount with its unit", () => {
    const of = (code: string, value: number, unit: string | null) =>
      amount(shown(live(code, { value, unit })), "en");
    expect(of("silent", 4.9, "s")).toBe("4 s");
    expect(of("silent", 65.2, "s")).toBe("1:05");
    expect(of("gap", 0.512, "s")).toBe("0.51 s");
    expect(of("clock_uncertain", 12.4, "ms")).toBe("± 12 ms");
    expect(of("low_frame_rate", 61.2, "Hz")).toBe("61 Hz");
    expect(of("too_slow", 1.25, "Hz")).toBe("1.3 Hz");
    expect(of("bad_values", 3, null)).toBe("3");
    expect(of("jump", 2, null)).toBeNull();
  });

  it("leave out an amount that has grown since it was recorded", () => {
    expect(fromRecord(recorded("silent", { value: 3, unit: "s" })).value).toBeNull();
    expect(fromRecord(recorded("gap", { value: 0.5, unit: "s" })).value).toBe(0.5);
  });

  it("name at most three joints", () => {
    expect(jointNames(shown(live("jump")))).toBeNull();
    expect(jointNames(shown(live("jump", { joints: ["LeftHand"] })))).toBe("Left Hand");
    const many = ["LeftHand", "Head", "Neck", "Spine"];
    expect(jointNames(shown(live("frozen", { joints: many })))).toBe("Left Hand, Head, Neck …");
  });
});

describe("messages about the headset", () => {
  const signal = {
    frame_rate_hz: 90,
    usual_rate_hz: 90,
    gaps: 0,
    gap_s: 0,
    frames_flagged: 0,
    clock_uncertainty_ms: 1,
    behind_s: 0,
  };

  it("keep the clock's last report if they come without frames", () => {
    const store = new TelemetryStore();
    const figures: TelemetryNews = { phase_id: 1, active_s: 3, fps: 90, signal, alarms: [] };
    store.put(figures);
    const before = store.latest();
    store.put({ signal, alarms: [live("silent")] });
    expect(store.latest()).toBe(before);
    expect(store.quality()?.alarms.map(({ code }) => code)).toEqual(["silent"]);
  });
});
