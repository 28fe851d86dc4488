import { itIsTranslated } from "@shared/i18n/tableTests";
import { describe } from "vitest";
import { allDe, allEn } from "./tables";

describe("every text of the console", () => itIsTranslated(allEn, allDe));
