/** The texts of the self-test in English; `de.ts` has the same keys. */
import { verdictsEn } from "@shared/selfTest/texts";

export const selfTestEn = {
  ...verdictsEn,
  "selftest.button": "Test this headset (2 minutes)",
  "selftest.buttonOnScreen": "Test this computer on the screen (2 minutes)",
  "selftest.what":
    "Measures frame rate, physics, tracking and storage on this device. Nothing of it belongs to a session.",
  "selftest.title": "Test of this headset",
  "selftest.stop": "Stop the test",
  "selftest.heldBack":
    "Not while the session is under way: the test is possible again before the body is entered and after the end.",
  "selftest.awaited.body":
    "Waiting for the body and its physics: {{waited}} of at most {{most}} s.",
  "selftest.awaited.sending": "Waiting for the server's storage: {{waited}} of at most {{most}} s.",
  "selftest.awaited.picture":
    "Waiting for the first picture of the body: {{waited}} of at most {{most}} s.",
  "selftest.unseen.title": "This device drew no pictures",
  "selftest.unseen.body":
    "In the time of a whole test there were too few pictures to measure anything. Bring this page to the front, close other programs and tabs, and turn on graphics acceleration in the browser's settings. Then test again.",
  "selftest.preparing.title": "Preparing the test",
  "selftest.preparing.body": "The room and the body are being loaded. It takes a few seconds.",
  "selftest.step": "Test, part {{number}} of {{total}}",
  "selftest.look.title": "Look around",
  "selftest.look.body":
    "Turn your head slowly to the left and right, up and down. Then look over your shoulders.",
  "selftest.hands.title": "Move both hands in front of you",
  "selftest.hands.body":
    "Reach forward, up and to the sides, as if you touched boxes at arm's length. Keep the hands in view.",
  "selftest.step.title": "Step on the spot",
  "selftest.step.body": "Lift your knees in turn, and put your feet forward, back and to the side.",
  "selftest.free.title": "Move as you like",
  "selftest.free.body":
    "Look at your body in the mirror and move all of it: squat, wave, turn around.",
  "selftest.scripted":
    "Nobody is tracked at the moment: a scripted person moves the body, and the report says so.",
  "selftest.left": "{{time}} left",
  "selftest.sending.title": "Storing the report",
  "selftest.sending.body": "One moment.",
  "selftest.kept.title": "The report is safe on this device",
  "selftest.kept.body":
    "The study computer does not answer. The report is kept and sent as soon as it is back; you do not have to wait for it.",
  "selftest.ok.title": "Everything is fine",
  "selftest.warn.title": "Usable, with something to know",
  "selftest.fail.title": "This needs attention before a study",
  "selftest.count": "{{ok}} of {{total}} figures are fine.",
  "selftest.more_one": "and one more on the page",
  "selftest.more_other": "and {{count}} more on the page",
  "selftest.notWorn":
    "Nobody wore the headset: this shows that the page works, not how good the device is.",
  "selftest.stored": "The report is stored.",
  "selftest.where": "On the study computer: Equipment > Headset tests.",
  "selftest.leave": "Leave VR",
  "selftest.again": "Test again",
  "selftest.back": "Back",
  "selftest.short.title": "Stopped early",
  "selftest.short.body":
    "Less than {{seconds}} s were measured. That says nothing about the device, so nothing was stored.",
  "selftest.visit.title": "The test has ended because the session goes on",
  "selftest.visit.body": "Enter VR for the session. Test the headset before or after it.",
  "selftest.failed.title": "The test could not be started",
  "selftest.waiting_one": "One report of a test waits on this device to be stored.",
  "selftest.waiting_other": "{{count}} reports of tests wait on this device to be stored.",
  "selftest.refused_one":
    "The study computer does not take this report, and will not take it later. Test the headset again.",
  "selftest.refused_other":
    "The study computer does not take {{count}} reports, and will not take them later. Test the headset again.",
  "selftest.discard_one": "Delete the report from this device",
  "selftest.discard_other": "Delete {{count}} reports from this device",
  "selftest.retry": "Send now",
  "selftest.summary": "{{device}}, {{frames}} frames in {{duration}}, moved by: {{inputs}}",
} as const;
