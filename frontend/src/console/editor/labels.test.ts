import { describe, expect, it } from "vitest";
import { allEn } from "../i18n/tables";
import { fieldKey } from "./formContext";

describe("The labels of fields with the same name", () => {
  const texts: Readonly<Record<string, string>> = allEn;

  it("say at a step where it is answered, and at what counts which questionnaires", () => {
    expect(texts[fieldKey("forms", ["valid_when"])]).toContain("questionnaires was answered");
    expect(texts[fieldKey("forms", ["procedure", "before", 2])]).toBeUndefined();
    expect(texts["field.forms"]).toMatch(/tablet.*headset/);
  });
});
