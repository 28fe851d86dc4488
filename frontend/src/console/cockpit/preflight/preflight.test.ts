import type { Check } from "@shared/api/types";
import { registryEn } from "@shared/session/registries.generated";
import { describe, expect, it } from "vitest";
import {
  amountOf,
  expectationOf,
  failing,
  refetchIntervalFor,
  todoOf,
  valuesOf,
} from "./checkTexts";

const check = (more: Partial<Check>): Check => ({
  key: "clock",
  status: "ok",
  code: "clock.ok",
  details: [],
  ...more,
});

describe("the texts of a check", () => {
  it("give quantities with their unit, and counts without", () => {
    expect(amountOf(1.84, "ms", "en")).toBe("1.8 ms");
    expect(amountOf(10.1, "ms", "en")).toBe("10.1 ms");
    expect(amountOf(741.4, "ms", "en")).toBe("741 ms");
    expect(amountOf(3730.2, "ms", "en")).toBe("3.7 s");
    expect(amountOf(89.94, "Hz", "en")).toBe("90 Hz");
    expect(amountOf(1.1, "GB", "de")).toBe("1,1 GB");
    expect(amountOf(22, "joints", "en")).toBe("22");
    expect(valuesOf(check({}), "en")).toEqual({ value: "–", limit: "–" });
  });

  it("name a limit only if it is a quantity", () => {
    const limited = { expected: "at_most", limit: 10 } as const;
    expect(expectationOf(check({ unit: "ms", ...limited }))).toBe("preflight.expected.at_most");
    expect(expectationOf(check({ unit: "phases", ...limited }))).toBeNull();
  });

  it("give a remedy for every check that can fail", () => {
    const failures = Object.keys(registryEn)
      .filter((key) => key.startsWith("preflight.todo."))
      .map((key) => key.slice("preflight.todo.".length));
    expect(failures).toContain("storage.failing");
    expect(todoOf(check({ status: "fail", code: "clock.uncertain" }))).toBe(
      "preflight.todo.clock.uncertain",
    );
    expect(todoOf(check({ status: "overridden", code: "clock.uncertain" }))).toBeNull();
    const found = Object.keys(registryEn).filter((key) => key.startsWith("preflight.found."));
    for (const code of failures) expect(found).toContain(`preflight.found.${code}`);
  });

  it("are refreshed while something is missing, and sooner while somebody is connecting a device", () => {
    const wait = check({ status: "wait" });
    const fail = check({ key: "disk", status: "fail", code: "disk.low" });
    expect(refetchIntervalFor([check({}), wait])).toBe(3000);
    expect(refetchIntervalFor([check({}), fail])).toBe(20_000);
    expect(refetchIntervalFor([check({}), check({ status: "overridden" })])).toBe(false);
    expect(failing([wait, fail])).toEqual([fail]);
  });
});
