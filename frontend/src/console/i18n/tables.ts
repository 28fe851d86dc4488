/**
 * All texts of the console in both languages. A page does not import this module, of which it would
 * load both: `textTables.ts` makes a module of each table.
 */
import { proseDe, proseEn } from "@shared/prose/texts";
import { verdictsDe, verdictsEn } from "@shared/selfTest/texts";
import { registryDe, registryEn } from "@shared/session/registries.generated";
import { avatarChangesDe, avatarChangesEn } from "../avatarChanges/texts";
import { avatarEditingDe, avatarEditingEn } from "../avatarEditor/editingTexts";
import { avatarsDe, avatarsEn } from "../avatarEditor/texts";
import { tryoutDe, tryoutEn } from "../avatarEditor/tryout/texts";
import { tuningDe, tuningEn } from "../avatarEditor/tuning/texts";
import { bodiesDe, bodiesEn } from "../bodies/texts";
import { bodyViewDe, bodyViewEn } from "../bodyView/texts";
import { jointMapDe, jointMapEn } from "../captures/jointMapTexts";
import { capturesDe, capturesEn } from "../captures/texts";
import { verificationDe, verificationEn } from "../captures/verificationTexts";
import { captureViewDe, captureViewEn } from "../captures/viewTexts";
import { liveDe, liveEn } from "../cockpit/live3d/texts";
import { preflightDe, preflightEn } from "../cockpit/preflight/texts";
import { eventsDe, eventsEn } from "../cockpit/record/eventTexts";
import { safetyDe, safetyEn } from "../cockpit/step/safetyTexts";
import { downloadsDe, downloadsEn } from "../downloads/texts";
import { fieldsDe, fieldsEn } from "../editor/fields/texts";
import { editorDe, editorEn } from "../editor/texts";
import { frameDe, frameEn } from "../frame/frameTexts";
import { helpPagesDe, helpPagesEn } from "../help/helpTexts";
import { homeDe, homeEn } from "../home/texts";
import { importsDe, importsEn } from "../imports/texts";
import { instrumentsDe, instrumentsEn } from "../instruments/texts";
import { consentDe, consentEn } from "../pages/consent/texts";
import { selfTestsDe, selfTestsEn } from "../pages/equipment/selfTestTexts";
import { equipmentDe, equipmentEn } from "../pages/equipment/texts";
import { joinDe, joinEn } from "../pages/join/texts";
import { networkDe, networkEn } from "../pages/network/texts";
import { outageDe, outageEn } from "../pages/outage/texts";
import { auditDe, auditEn } from "../pages/people/auditTexts";
import { peopleDe, peopleEn } from "../pages/people/texts";
import { analysisDe, analysisEn } from "../pages/study/analysisTexts";
import { expertDe, expertEn } from "../pages/study/suggestionTexts";
import { studyDe, studyEn } from "../pages/study/texts";
import { validityDe, validityEn } from "../pages/study/validityTexts";
import { versionsDe, versionsEn } from "../pages/study/versionTexts";
import { trackersDe, trackersEn } from "../pages/trackers/texts";
import { performerDe, performerEn } from "../performer/texts";
import { pilotDe, pilotEn } from "../pilot/texts";
import { preregistrationDe, preregistrationEn } from "../preregistration/texts";
import { replayDe, replayEn } from "../replay/texts";
import { rightsDe, rightsEn } from "../rights/texts";
import { storageDe, storageEn } from "../storage/texts";
import { tourDe, tourEn } from "../tour/texts";
import { walkingModelDe, walkingModelEn } from "../walking/modelTexts";
import { walkingDe, walkingEn } from "../walking/texts";
import { walkSetDe, walkSetEn } from "../walking/walkSetTexts";
import { de } from "./de";
import { en } from "./en";

export const allEn = {
  ...en,
  ...avatarChangesEn,
  ...avatarEditingEn,
  ...avatarsEn,
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
  ...trackersEn,
  ...performerEn,
  ...selfTestsEn,
  ...verdictsEn,
  ...capturesEn,
  ...captureViewEn,
  ...bodiesEn,
  ...tryoutEn,
  ...tuningEn,
  ...bodyViewEn,
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
  ...frameEn,
  ...homeEn,
  ...analysisEn,
  ...eventsEn,
  ...outageEn,
  ...importsEn,
  ...pilotEn,
  ...preregistrationEn,
  ...proseEn,
};
export const allDe: Readonly<Record<keyof typeof allEn, string>> = {
  ...de,
  ...avatarChangesDe,
  ...avatarEditingDe,
  ...avatarsDe,
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
  ...trackersDe,
  ...performerDe,
  ...selfTestsDe,
  ...verdictsDe,
  ...capturesDe,
  ...captureViewDe,
  ...bodiesDe,
  ...tryoutDe,
  ...tuningDe,
  ...bodyViewDe,
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
  ...frameDe,
  ...homeDe,
  ...analysisDe,
  ...eventsDe,
  ...outageDe,
  ...importsDe,
  ...pilotDe,
  ...preregistrationDe,
  ...proseDe,
};

export const tables = { en: allEn, de: allDe } as const;
