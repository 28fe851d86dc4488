import { itIsTranslated } from "@shared/i18n/tableTests";
import { describe } from "vitest";
import { translations } from ".";

const tableOf = (language: string): Readonly<Record<string, string>> =>
  translations.getResourceBundle(language, "translation");

describe("every text of the console", () => itIsTranslated(tableOf("en"), tableOf("de")));
