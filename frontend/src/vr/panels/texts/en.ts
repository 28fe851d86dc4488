/** The texts of the panels in the headset, in English; `de.ts` has the same keys. */
import { formEn } from "@shared/forms/texts";

export const en = {
  ...formEn,
  "form.submit": "Send answers",
  "reading.page": "Page {{page}} of {{pages}}",
  "reading.done": "I have read this",
  "reading.ask": "I have a question",
  "reading.asked.title": "The experimenter has been called",
  "reading.asked.body": "Please ask your question out loud. You can continue afterwards.",
  "reading.continue": "Continue",
  "form.start": "Start",
  "form.intro_one": "There is one question.",
  "form.intro_other":
    "There are {{count}} questions, one after the other. You can go back at any time.",
  "form.how": "Point at an answer. Press the trigger, or touch your thumb with your index finger.",
  "form.question": "Question {{number}} of {{total}}",
  "form.review": "Check answers",
  "form.review.title": "Your answers",
  "form.review.body": "Point at a question to change its answer.",
  "form.review.page": "{{page}} of {{pages}}",
  "form.review.more": "More",
  "form.spoken": "I will say it to the experimenter",
  "form.nothing": "Nothing to say",
  "form.spoken.lead":
    "You cannot type here. Say your answer to the experimenter, who writes it down.",
  "form.unanswered": "not answered",
  "form.tooLong":
    "This is too long to be shown in the headset. Please tell the experimenter, who asks it aloud.",
  "form.delete": "Delete",
  "sending.title": "Sending your answers",
  "sending.body": "One moment.",
  "sending.offline": "Your answers are safe",
  "sending.offlineBody":
    "There is no connection at the moment. Your answers are kept in this headset and sent as soon as the connection is back. Please tell the experimenter.",
  "sending.retry": "Try again",
  "refused.title": "Something has to be corrected",
  "refused.body": "The server could not take these answers. Please check them once more.",
  "held.title": "These answers are not needed now",
  "held.body": "They are kept in this headset. Please tell the experimenter.",
  "sent.title": "Thank you, your answers are stored",
  "sent.body": "We will continue in a moment.",
  "waiting.title": "Please wait a moment",
  "waiting.body":
    "There is nothing to do here right now. The experimenter will tell you when to continue.",
  "standby.title": "Ready",
  "standby.body":
    "You are connected. Take your time to look around. The experimenter will start when you are ready.",
  "standby.stop":
    "You can stop at any time: hold one hand above your head, or squeeze both grips, for one second.",
  "standby.stopHands": "You can stop at any time: hold one hand above your head for one second.",
  "pairing.title": "Connect this headset",
  "pairing.body":
    "Take the headset off for a moment and enter the code that the experimenter shows.",
  "offline.title": "No connection",
  "offline.body":
    "The connection to the study computer is interrupted. Nothing is lost. Please wait; the experimenter knows.",
  "takeOff.title": "Please take the headset off",
  "takeOff.body":
    "The next part is not in the headset. Stand still, close your eyes for a moment and lift the headset off. The experimenter is with you.",
  "takeOff.told": "The experimenter has been told.",
  "takeOff.form":
    "The next questions are on the tablet. Stand still, close your eyes for a moment and lift the headset off.",
  "finished.title": "That is all, thank you",
  "finished.body": "You can take the headset off now. The experimenter helps you.",
  "stop.hold": "Hold to stop",
  "stop.cancel": "Lower your hand to go on",
  "stop.cancelGrips": "Let go to go on",
  "pause.title": "You have stopped",
  "pause.body":
    "The experimenter has been told and is coming to you. Breathe calmly, look around, or take the headset off. Nothing happens until you want to go on.",
  "pause.telling": "The experimenter is being told.",
  "pause.untold": "The experimenter could not be told. Please call out loud.",
  "pause.operator.title": "A short break",
  "pause.operator.body": "The session is paused. You do not have to do anything.",
  "pause.resume": "It goes on when the experimenter continues.",
  "comfort.title": "How are you?",
  "comfort.body":
    "If you feel dizzy or unwell, say so or stop. Stopping has no disadvantage for you.",
  decimal: ".",
  "boundary.area": "Your play area",
  "boundary.title": "Close to the edge",
  "boundary.body": "Please step back to the middle of the room.",
  "boundary.missing":
    "This headset has no play area set up. Please ask the experimenter to set one up before you move.",
  "boundary.small":
    "The play area is smaller than this study needs: {{haveM}} by {{haveDepthM}} m instead of {{needM}} by {{needDepthM}} m. Please tell the experimenter.",
  "steppingIn.title": "Step into the figure",
  "steppingIn.body":
    "Stand in the transparent figure with your arms stretched out like its arms. Then press both grips.",
  "steppingIn.bodyHands":
    "Stand in the transparent figure with your arms stretched out like its arms. Then make two fists.",
  "steppingIn.keys": "On this screen: Space presses both grips, T stretches out the arms.",
  "ready.body": "The experimenter starts as soon as you are ready.",
  "toStart.body":
    "Stand on the white square. It starts when the traffic does; let yourself be guided there.",
  "toStart.keys":
    "On this screen: press S to walk back until you stand on the white square; A and D go sideways, W forwards.",
  "preparing.countdown": "Starts in {{seconds}} s",
  "preparing.traffic": "Starts as soon as the traffic does",
  "aloud.title": "Please answer aloud",
  "aloud.body":
    "The experimenter asks you the questions and writes down what you say. You can keep the headset on.",
  "lookAround.title": "Please look around",
  "lookAround.body":
    "Turn your head slowly to the left and right, then look up and down, until this sign disappears. So your trackers are found.",
  "feet.body":
    "This task cannot start: your feet are not measured at the moment. The experimenter has been told.",
  "elsewhere.title": "Please look at the tablet",
  "elsewhere.form": "The next questions are on the tablet. It goes on here afterwards.",
  "elsewhere.body": "The next part is on the tablet. It goes on here afterwards.",
  "boundary.goOn": "Go on like this",
  "form.loading": "Your questions are being fetched",
  "calibration.step": "Step {{number}} of {{total}}",
  "calibration.square.title": "Stand still on the square",
  "calibration.square.body":
    "Look straight ahead. Is this text blurred? Then move the headset up or down until it is sharp.",
  "calibration.n_pose.title": "Stand upright, arms down",
  "calibration.n_pose.body":
    "Stand straight with your feet side by side. Let both arms hang. Look ahead and stay still for 2 seconds.",
  "calibration.t_pose.title": "Stretch your arms out to the sides",
  "calibration.t_pose.body":
    "Both arms straight, as high as your shoulders, palms down. Stay still for 2 seconds.",
  "calibration.measuring": "Stay like that: {{seconds}}",
  "calibration.squat.title": "Bend your knees, come up again",
  "calibration.squat.body":
    "Bend your knees a little, as if to sit down, then stand upright again and stay still.",
  "calibration.reach.title": "Reach forward",
  "calibration.reach.body": "Stretch both hands out in front of you, as high as your shoulders.",
  "calibration.mirror.title": "Look into the mirror",
  "calibration.mirror.body":
    "Move your arms and legs slowly. Does the figure move as you do? If you press nothing, it goes on by itself.",
  "calibration.mirror.good": "It moves as I do",
  "calibration.mirror.bad": "Something is wrong",
  "calibration.again": "Once more, please:",
  "calibration.seconds": "{{seconds}} s",
  "calibration.skip": "Leave this out",
  "problem.off_square.forward": "Please go {{distanceCm}} cm forward.",
  "problem.off_square.back": "Please go {{distanceCm}} cm back.",
  "problem.off_square.left": "Please go {{distanceCm}} cm to the left.",
  "problem.off_square.right": "Please go {{distanceCm}} cm to the right.",
  "problem.turned.left": "Please turn to the left, towards the mirror.",
  "problem.turned.right": "Please turn to the right, towards the mirror.",
  "problem.looking": "Please look straight ahead.",
  "problem.bent_knees": "Your knees are bent. Please stand up straight.",
  "problem.bent_elbows": "Please straighten your arms.",
  "problem.arms_not_down": "Please let both arms hang down.",
  "problem.arms_not_level": "Please raise both arms to the height of your shoulders.",
  "problem.arm_too_high": "Please lower your arms a little.",
  "problem.feet_apart": "Please put your feet side by side.",
  "problem.swapped_hands":
    "Left and right hand are swapped. Please give the controllers to the other hands.",
  "problem.swapped_shins":
    "The trackers of the left and the right leg are swapped. Please tell the experimenter.",
  "problem.moving": "Please keep still.",
  "problem.lost":
    "The {{part}} is not seen at the moment. Please move so that nothing is in the way.",
  "problem.not_bent": "Please bend your knees a little more.",
  "problem.not_reached": "Please reach further forward.",
  "problem.palms_not_down": "Please turn your palms to the floor.",
  "problem.not_upright": "Please stand up straight again.",
  "problem.goal_error": "The {{part}} was {{errorCm}} cm away from where it should be.",
  "problem.implausible":
    "That gives a height of {{valueCm}} cm. Please stand upright, or tell the experimenter that the headset's floor is wrong.",
  "part.Head": "head",
  "part.Hips": "waist",
  "part.LeftHand": "left hand",
  "part.RightHand": "right hand",
  "part.LeftLowerLeg": "left shin",
  "part.RightLowerLeg": "right shin",
} as const;
