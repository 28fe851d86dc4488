/** The words of the self-test, in the headset and on its page. */
import type { KeyOf, Translate } from "@shared/i18n/i18n";
import { wordsIn } from "@shared/i18n/words";
import { selfTestDe } from "./de";
import { selfTestEn } from "./en";

export { selfTestDe, selfTestEn };

export type SelfTestKey = KeyOf<typeof selfTestEn>;
export type SelfTestWords = Translate<SelfTestKey>;

export const selfTestWords = (language: string): SelfTestWords =>
  wordsIn<typeof selfTestEn>({ en: selfTestEn, de: selfTestDe }, language);
