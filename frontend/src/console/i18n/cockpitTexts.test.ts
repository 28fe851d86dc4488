import { describe, expect, it } from "vitest";
import { liveDe, liveEn } from "./liveTexts";
import { preflightDe, preflightEn } from "./preflightTexts";
import { registryDe, registryEn } from "./registries.generated";

const placeholders = (text: string | undefined) =>
  [...(text ?? "").matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe("the texts of pre-flight, registries and live view", () => {
  it("have the same placeholders in both languages", () => {
    const en: Readonly<Record<string, string>> = { ...registryEn, ...preflightEn, ...liveEn };
    const de: Readonly<Record<string, string>> = { ...registryDe, ...preflightDe, ...liveDe };
    for (const key of Object.keys(en)) {
      expect(de[key]?.trim()).toBeTruthy();
      expect([key, placeholders(de[key])]).toEqual([key, placeholders(en[key])]);
    }
  });
});
