import { itIsTranslated } from "@shared/i18n/tableTests";
import { describe } from "vitest";
import { de } from "./de";
import { en } from "./en";

describe("the panels' texts", () => itIsTranslated(en, de));
