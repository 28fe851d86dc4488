/** The participant's texts in English; `de.ts` has the same keys. */

import { formEn } from "@shared/forms/texts";
import { proseEn } from "@shared/prose/texts";
import { pageEn } from "@shared/ui/pageTexts";

export const en = {
  ...pageEn,
  ...formEn,
  ...proseEn,
  "pair.title": "Connect this tablet",
  "pair.lead":
    "Enter the code shown on the experimenter's screen. If a QR code is beside it, you can scan that instead.",
  "pair.code": "Pairing code",
  "pair.delete": "Delete last character",
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
  "bar.simulated": "Simulated session",
  "bar.offline": "No connection. Your answers are kept on this tablet.",
  "bar.language": "Language",
  "bar.textSize": "Text size: {{percent}} %. Press to change",
  "help.call": "Call the experimenter",
  "help.called": "The experimenter has been called",
  "help.takeBack": "No longer needed",
  "help.failed": "The call cannot be sent right now. Please ask us in person.",
  "waiting.title": "Please wait a moment",
  "waiting.body":
    "There is nothing to do here right now. The experimenter will tell you when to continue.",
  "elsewhere.in_headset":
    "The questions are shown inside the headset. Please put it on, or leave it on.",
  "elsewhere.oral": "The experimenter asks you the questions. Please answer aloud.",
  "waiting.next": "Next",
  "consent.title": "Consent",
  "consent.go": "I agree to take part",
  "consent.statements": "Please tick what you agree to",
  "consent.signature": "Your signature",
  "consent.surface": "Area for signing with a finger, pen or mouse",
  "consent.clear": "Clear",
  "consent.type": "Type my name instead",
  "consent.draw": "Draw my signature instead",
  "consent.name": "First and last name",
  "consent.missing.statements": "Please tick every statement that is not optional.",
  "consent.missing.name": "Please enter your name.",
  "consent.missing.signature": "Please sign in the area above.",
  "held.wait.title": "Please wait, the experimenter is coming",
  "held.wait.body":
    "You have done nothing wrong. You can take the headset off and sit down if you like.",
  "instructions.title": "Instructions",
  "instructions.go": "I have read this",
  "instructions.ask": "Is anything unclear?",
  "instructions.askBody":
    "Please ask the experimenter now. There is time, and no question is too small.",
  "reading.more": "Read on",
  "ask.question": "I have a question",
  "ask.decline": "I do not want to take part",
  "ask.question.title": "The experimenter has been called",
  "ask.question.body": "Please ask your question. You can continue here afterwards.",
  "refused.title": "That is all right",
  "refused.told": "The experimenter knows that you do not want to take part, and will come to you.",
  "refused.telling": "The experimenter is being notified.",
  "refused.untold":
    "This tablet cannot reach the experimenter at the moment. Please tell the experimenter that you do not want to take part.",
  "refused.free": "You do not have to give a reason, and refusing puts you at no disadvantage.",
  "refused.takeBack": "I have changed my mind",
  "form.submit": "Send answers",
  "sending.title": "Sending your answers",
  "sending.body": "One moment.",
  "sending.offline": "Your answers are safe",
  "sending.offlineBody":
    "There is no connection at the moment. Your answers are kept on this tablet and sent as soon as the connection is back. Please tell the experimenter.",
  "held.title": "These answers are not needed now",
  "held.body": "They are kept on this tablet. Please tell the experimenter.",
  "sent.title": "Thank you, your answers are stored",
  "sent.body": "We will continue in a moment.",
  "finished.refused.title": "Thank you for your time",
  "finished.refused.body":
    "You did not take part. Please give the tablet back to the experimenter, who will gladly answer your questions.",
  "finished.title": "Thank you for taking part",
  "finished.body":
    "You are done. Please give the tablet back to the experimenter, who will gladly answer your questions.",
} as const;
