/** The texts of the headset's page in English; `de.ts` has the same keys. */
import { pageEn } from "@shared/ui/pageTexts";
import { selfTestEn } from "../selftest/texts/en";

export const en = {
  ...pageEn,
  ...selfTestEn,
  "enter.title": "Enter the study",
  "enter.lead": "Put the headset on and make sure the picture is sharp. Then press the button.",
  "enter.button": "Enter VR",
  "enter.name": "Name of this device",
  "enter.name.hint":
    "Such as “Quest 3, room 2”. Kept by this browser, and shown with tests and at the next pairing.",
  "enter.onScreen": "Act on this screen",
  "enter.again": "Return to VR",
  "enter.language": "Language",
  "enter.simulated": "Simulated session",
  "enter.connecting": "Connecting to the study computer",
  "enter.offline":
    "The connection is lost and is being restored. Everything recorded so far is kept on this headset.",
  "enter.over": "The session has ended",
  "enter.overBody": "You can take the headset off. Thank you for taking part.",
  "enter.next": "For the next session, enter its code.",
  "enter.failed": "VR could not be started",
  "enter.stopped": "This headset has stopped",
  "enter.withdrawn":
    "The participant has withdrawn. What this headset still had of the session was deleted.",
  "enter.inUse": "This study is open in another tab",
  "enter.inUse.remedy": "Close the other tab, then reload this page.",
  "enter.takenOver": "Another page of this headset goes on with the session",
  "enter.takenOver.remedy": "Continue there. To go on here, reload this page.",
  "enter.foreign": "This headset still keeps recordings of another session",
  "enter.foreign.remedy":
    "They have not reached the study computer. Pair the headset with that session again first: they are sent as soon as it is connected. Then use the code of this session.",
  "enter.ended": "VR was closed. The session waits until you return.",
  "enter.disconnect": "Use another code",
  "pair.title": "Connect this headset",
  "pair.lead": "Enter the code shown on the experimenter's screen.",
  "pair.code": "Pairing code",
  "pair.delete": "Delete last character",
  "pair.connecting": "Connecting",
  "pair.ended.title": "This headset was disconnected",
  "pair.ended.body":
    "The experimenter has to connect it again. What was recorded so far is kept on this headset.",
  "pair.tablet": "This code belongs to a tablet.",
  "pair.tabletRemedy": "Ask the experimenter for the code of the headset.",
  "error.unreachable": "The headset has no connection to the study computer.",
  "error.unreachableRemedy": "Check the wireless network of the headset, then try again.",
  "error.unexpected": "Something went wrong on this page.",
  "error.retry": "Try again",
  "support.insecure": "VR needs a secure connection",
  "support.insecure.quest":
    "Connect the headset to the computer by USB cable, run “adb reverse tcp:8321 tcp:8321” there, and open http://localhost:8321/vr here. Or open the https address of the page Network in the console and accept the browser's warning once.",
  "support.insecure.pico":
    "Open the https address shown on the page Network in the console and accept the browser's warning once. A USB cable works as well: run “adb reverse tcp:8321 tcp:8321” on the computer and open http://localhost:8321/vr here.",
  "support.insecure.vision_pro":
    "Open the https address shown on the page Network in the console. Install the lab's certificate from the help page first: Safari refuses live connections without it.",
  "support.insecure.android_xr":
    "Open the https address shown on the page Network in the console. Install the lab's certificate in the settings first, or accept the browser's warning once.",
  "support.insecure.computer":
    "Open this page as http://localhost:8321/vr on the study computer, or at the https address shown on the page Network in the console.",
  "support.no_webxr": "This browser cannot show VR",
  "support.no_webxr.quest":
    "Update the headset's browser: it needs Meta Quest Browser 15 or newer.",
  "support.no_webxr.pico": "Update the headset's browser: it needs PICO Browser 4 or newer.",
  "support.no_webxr.vision_pro":
    "Update to visionOS 2 or newer. On visionOS 1 switch on WebXR in Settings > Apps > Safari > Advanced > Feature Flags.",
  "support.no_webxr.android_xr": "Open this page in Chrome and update it.",
  "support.no_webxr.computer":
    "Open this page in the headset's own browser, or in Chrome or Edge on a computer with a headset. To try the study without a headset, pair this page and choose “Act on this screen”.",
  "support.no_headset": "No headset was found",
  "support.no_headset.quest": "Restart the headset's browser and open this page again.",
  "support.no_headset.pico": "Restart the headset's browser and open this page again.",
  "support.no_headset.vision_pro": "Restart Safari and open this page again.",
  "support.no_headset.android_xr": "Restart Chrome and open this page again.",
  "support.no_headset.computer":
    "Start SteamVR or the headset's own program and switch the headset on; this page notices it by itself. To try the study without a headset, pair this page and choose “Act on this screen”.",
  "operator.title": "What the experimenter presses",
  "operator.next": "The experimenter's next step:",
  "operator.runs": "The task is running.",
  "operator.elsewhere": "The next part is not on this page: it is in the console or on the tablet.",
  "operator.enter": "Enter",
  "operator.console": "Open the console",
  "operator.stale": "The session had gone on meanwhile. This is its next step now.",
  "operator.waits": "It goes on when the experimenter continues in the console.",
  "operator.signIn": "Are you the experimenter? Sign in to go on from here",
  "desktop.title": "Desktop mode",
  "desktop.starting": "Preparing the study on this screen",
  "desktop.begin": "Click into the picture to look around with the mouse. Esc releases it.",
  "desktop.hit":
    "To hit a box: look at it, hold the right mouse button, and turn the wheel until the hand touches it. A box for a foot: look at it and press Q or E.",
  "desktop.slow.title": "This device draws only {{rate}} pictures a second.",
  "desktop.slow.body":
    "The session's clock stands still until there are at least {{least}}. Close other programs and tabs, make this window smaller, turn on graphics acceleration in the browser's settings, or use a faster computer.",
  "desktop.mouse": "Mouse",
  "desktop.look": "look around",
  "desktop.rightButton": "Right button",
  "desktop.reach": "reach to where you look",
  "desktop.wheel": "Wheel",
  "desktop.depth": "reach nearer or farther",
  "desktop.leftButton": "Left button",
  "desktop.select": "select",
  "desktop.walk": "walk",
  "desktop.feet": "step there with the left or right foot",
  "desktop.grips": "press both grips: enter the body",
  "desktop.hand": "use the other hand",
  "desktop.squat": "squat",
  "desktop.tPose": "T-pose",
  "desktop.help": "show or hide this help",
  "desktop.space": "Space",
} as const;
