import {
  createTranslations,
  type KeyOf,
  preferredLanguage,
  type Texts,
  useTranslations,
} from "@shared/i18n/i18n";
import { helpPagesDe, helpPagesEn } from "../help/helpTexts";
import { analysisDe, analysisEn } from "./analysisTexts";
import { auditDe, auditEn } from "./auditTexts";
import { capturesDe, capturesEn } from "./captureTexts";
import { captureViewDe, captureViewEn } from "./captureViewTexts";
import { consentDe, consentEn } from "./consentTexts";
import { de } from "./de";
import { downloadsDe, downloadsEn } from "./downloadTexts";
import { editorDe, editorEn } from "./editorTexts";
import { en } from "./en";
import { equipmentDe, equipmentEn } from "./equipmentTexts";
import { expertDe, expertEn } from "./expertTexts";
import { fieldsDe, fieldsEn } from "./fieldTexts";
import { importsDe, importsEn } from "./importTexts";
import { instrumentsDe, instrumentsEn } from "./instrumentTexts";
import { joinDe, joinEn } from "./joinTexts";
import { jointMapDe, jointMapEn } from "./jointMapTexts";
import { liveDe, liveEn } from "./liveTexts";
import { networkDe, networkEn } from "./networkTexts";
import { peopleDe, peopleEn } from "./peopleTexts";
import { preflightDe, preflightEn } from "./preflightTexts";
import { preregistrationDe, preregistrationEn } from "./preregistrationTexts";
import { registryDe, registryEn } from "./registries.generated";
import { replayDe, replayEn } from "./replayTexts";
import { rightsDe, rightsEn } from "./rightsTexts";
import { safetyDe, safetyEn } from "./safetyTexts";
import { storageDe, storageEn } from "./storageTexts";
import { studyDe, studyEn } from "./studyTexts";
import { tourDe, tourEn } from "./tourTexts";
import { validityDe, validityEn } from "./validityTexts";
import { verificationDe, verificationEn } from "./verificationTexts";
import { versionsDe, versionsEn } from "./versionTexts";
import { walkingModelDe, walkingModelEn } from "./walkingModelTexts";
import { walkingDe, walkingEn } from "./walkingTexts";
import { walkSetDe, walkSetEn } from "./walkSetTexts";

const allEn = {
  ...en,
  ...peopleEn,
  ...joinEn,
  ...auditEn,
  ...networkEn,
  ...editorEn,
  ...fieldsEn,
  ...versionsEn,
  ...studyEn,
  ...instrumentsEn,
  ...rightsEn,
  ...safetyEn,
  ...validityEn,
  ...consentEn,
  ...expertEn,
  ...equipmentEn,
  ...capturesEn,
  ...captureViewEn,
  ...walkingEn,
  ...walkingModelEn,
  ...walkSetEn,
  ...jointMapEn,
  ...verificationEn,
  ...registryEn,
  ...preflightEn,
  ...liveEn,
  ...replayEn,
  ...downloadsEn,
  ...storageEn,
  ...tourEn,
  ...helpPagesEn,
  ...analysisEn,
  ...importsEn,
  ...preregistrationEn,
};
const allDe = {
  ...de,
  ...peopleDe,
  ...joinDe,
  ...auditDe,
  ...networkDe,
  ...editorDe,
  ...fieldsDe,
  ...versionsDe,
  ...studyDe,
  ...instrumentsDe,
  ...rightsDe,
  ...safetyDe,
  ...validityDe,
  ...consentDe,
  ...expertDe,
  ...equipmentDe,
  ...capturesDe,
  ...captureViewDe,
  ...walkingDe,
  ...walkingModelDe,
  ...walkSetDe,
  ...jointMapDe,
  ...verificationDe,
  ...registryDe,
  ...preflightDe,
  ...liveDe,
  ...replayDe,
  ...downloadsDe,
  ...storageDe,
  ...tourDe,
  ...helpPagesDe,
  ...analysisDe,
  ...importsDe,
  ...preregistrationDe,
};

export type Key = KeyOf<typeof allEn>;

const REMEMBERED = "reembody.console.language";
// Tests of modules that import these texts run where there is no storage.
const preferred = [globalThis.localStorage?.getItem(REMEMBERED) ?? [], navigator.languages].flat();

export const translations = createTranslations(
  { en: allEn, de: allDe },
  preferredLanguage(preferred),
);
translations.on("languageChanged", (language) => localStorage.setItem(REMEMBERED, language));

export const useTexts = (): Texts<Key> => useTranslations<Key>();
