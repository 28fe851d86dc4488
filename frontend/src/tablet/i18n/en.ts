/** The participant's texts in English; `de.ts` has the same keys. */
export const en = {
  "pair.title": "Connect this tablet",
  "pair.lead": "Enter the code that the experimenter's screen shows, or scan its QR code.",
  "pair.code": "Pairing code",
  "pair.delete": "Delete last character",
  "pair.connect": "Connect",
  "pair.connecting": "Connecting",
  "pair.ended.title": "This tablet was disconnected",
  "pair.ended.body":
    "The experimenter has to connect it again. What you have entered so far is kept on this tablet.",
  "pair.headset": "This code belongs to a headset.",
  "pair.headsetRemedy": "Ask the experimenter for the code of the tablet.",
  "error.unreachable": "The tablet has no connection to the study computer.",
  "error.unreachableRemedy": "Please tell the experimenter. Nothing you entered is lost.",
  "error.unexpected": "Something went wrong on this page.",
  "error.retry": "Try again",
} as const;
