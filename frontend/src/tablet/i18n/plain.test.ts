import { createTranslations, LANGUAGES } from "@shared/i18n/i18n";
import { describe, expect, it } from "vitest";
import { de } from "./de";
import { en } from "./en";
import { plainTexts } from "./plain";

describe("texts without the library", () => {
  it("are those of the library, in both languages", () => {
    const names = Object.values(en).flatMap((text) => [...text.matchAll(/{{(\w+)}}/g)]);
    const values = Object.fromEntries(names.map(([, name = ""], at) => [name, `<${name} ${at}>`]));
    for (const language of LANGUAGES) {
      const { t } = createTranslations({ en, de }, language);
      const plain = plainTexts(language);
      for (const key of Object.keys(en) as (keyof typeof en)[]) {
        expect(plain(key, values)).toBe(t(key, values));
      }
    }
  });
});
