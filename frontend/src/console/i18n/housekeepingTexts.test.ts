import { describe, expect, it } from "vitest";
import { downloadsDe, downloadsEn } from "./downloadTexts";
import { storageDe, storageEn } from "./storageTexts";
import { tourDe, tourEn } from "./tourTexts";

const placeholders = (text: string) =>
  [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe("the texts of downloads, storage and tour", () => {
  it.each([
    ["downloads", downloadsEn, downloadsDe],
    ["storage", storageEn, storageDe],
    ["tour", tourEn, tourDe],
  ] as const)("of %s fill in the same values in both languages", (_, en, de) => {
    const german: Readonly<Record<string, string>> = de;
    for (const [key, text] of Object.entries(en))
      expect([key, placeholders(german[key] ?? "")]).toEqual([key, placeholders(text)]);
  });
});
