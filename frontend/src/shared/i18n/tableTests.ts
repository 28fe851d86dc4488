import { expect, it } from "vitest";

const placeholders = (text: string): readonly string[] =>
  [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name ?? "").sort();

/** Test that two tables have the same keys, no empty text, and the same placeholders. */
export function itIsTranslated(
  en: Readonly<Record<string, string>>,
  de: Readonly<Record<string, string>>,
): void {
  const keys = Object.keys(en);

  it("has every text in both languages", () => {
    expect(Object.keys(de).sort()).toEqual([...keys].sort());
    expect(keys.filter((key) => en[key]?.trim() === "" || de[key]?.trim() === "")).toEqual([]);
  });

  it("has the same placeholders in both languages", () => {
    for (const key of keys)
      expect([key, placeholders(de[key] ?? "")]).toEqual([key, placeholders(en[key] ?? "")]);
  });
}
