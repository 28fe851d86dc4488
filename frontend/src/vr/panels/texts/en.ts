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
  "takeOff.form": "The next questions are on the tablet. Please take the headset off.",
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
  "pause.operator.body": "The experimenter has paused the session. You do not have to do anything.",
  "pause.resume": "It goes on when the experimenter continues.",
  "comfort.title": "How are you?",
  "comfort.body":
    "If you feel dizzy or unwell, say so or stop. Stopping has no disadvantage for you.",
  "boundary.title": "Close to the edge",
  "boundary.body": "Please step back to the middle of the room.",
  "boundary.missing":
    "This headset has no play area set up. Please ask the experimenter to set one up before you move.",
  "boundary.small":
    "The play area is smaller than this study needs: {{haveM}} by {{haveDepthM}} m instead of {{needM}} by {{needDepthM}} m. Please tell the experimenter.",
  "mirror.title": "Look into the mirror",
  "mirror.body":
    "Move your arms and legs slowly. Does the figure move as you do? The experimenter looks, too.",
  "mirror.good": "It moves as I do",
  "mirror.bad": "Something is wrong",
  "mirror.repeat": "Then we measure once more.",
  "calibration.step": "Step {{number}} of {{total}}",
  "calibration.fit.title": "Sit the headset right",
  "calibration.fit.body":
    "Move the headset up and down until this text is sharp, then tighten the strap. If it stays blurred, adjust the distance of the lenses.",
  "calibration.fit.sharp": "The text is sharp",
  "calibration.square.title": "Step onto the square",
  "calibration.square.body": "Stand on the square on the floor and look straight ahead.",
  "calibration.n_pose.title": "Stand upright, arms down",
  "calibration.n_pose.body":
    "Stand straight with your feet side by side. Let both arms hang. Look ahead and stay still for 2 seconds.",
  "calibration.t_pose.title": "Stretch your arms out to the sides",
  "calibration.t_pose.body":
    "Both arms straight, as high as your shoulders, palms down. Stay still for 2 seconds.",
  "calibration.look_around.title": "Look around",
  "calibration.look_around.body":
    "Turn your head slowly: left, right, up and down, for ten seconds. Keep your feet where they are.",
  "calibration.squat_reach.title": "Bend and reach",
  "calibration.squat_reach.body":
    "Bend your knees a little, come up again, then reach forward with both hands.",
  "calibration.measuring": "Stay like that",
  "calibration.moving": "Please keep still.",
  "calibration.done.title": "Done",
  "calibration.done.body": "Your body has been measured. Thank you.",
  "calibration.again.title": "Once more, please",
  "calibration.again.body":
    "The {{part}} is {{errorCm}} cm away from where it should be. We repeat this step.",
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
  "problem.implausible":
    "That does not fit: {{valueCm}} cm. Please stand upright and try again, or tell the experimenter.",
  "part.Head": "head",
  "part.Hips": "waist",
  "part.LeftHand": "left hand",
  "part.RightHand": "right hand",
  "part.LeftLowerLeg": "left shin",
  "part.RightLowerLeg": "right shin",
} as const;
