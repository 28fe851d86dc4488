/**
 * What the participant is told while the body is measured: one step at a time, and in words what is
 * still wrong. The steps themselves, and when one is good, are decided by the calibration.
 */
import type { CalibrationProblem, CalibrationPrompt } from "../../calibration";
import type { PanelButton, PanelScreen } from "../surface/screen";
import type { PanelWords } from "../texts";

const centimetres = (metres: number): number => Math.round(metres * 100);

/** A problem as a sentence that says what to do. */
export function problemText(words: PanelWords, problem: CalibrationProblem): string {
  switch (problem.kind) {
    case "off_square": {
      const distanceCm = Math.max(1, centimetres(problem.distanceM));
      return words(`problem.off_square.${problem.towards}`, { distanceCm });
    }
    case "turned":
      return words(`problem.turned.${problem.towards}`);
    case "lost":
      return words("problem.lost", { part: words(`part.${problem.part}`) });
    case "implausible":
      return words("problem.implausible", { valueCm: centimetres(problem.valueM) });
    case "goal_error": {
      const errorCm = centimetres(problem.errorM);
      return words("problem.goal_error", { part: words(`part.${problem.part}`), errorCm });
    }
    default:
      return words(`problem.${problem.kind}`);
  }
}

const TENTHS = 10;

/**
 * The screen of a step. Its targets: `skip` leaves the step out; at the mirror, `good` ends the
 * calibration and `bad` repeats it.
 */
export function calibrationScreen(words: PanelWords, prompt: CalibrationPrompt): PanelScreen {
  const { step, number, total, problem, held, secondsLeft, again } = prompt;
  const isMirror = step === "mirror";
  const isHeld = problem === null && held > 0;
  const why = again === null ? null : `${words("calibration.again")} ${problemText(words, again)}`;
  const texts = [why, words(`calibration.${step}.body`)];
  const seconds = words("calibration.seconds", { seconds: secondsLeft });
  const measuring = isMirror ? seconds : words("calibration.measuring", { seconds });
  return {
    key: `calibration ${step}`,
    // Who looks straight ahead sees the mirror, and the sign below.
    isLow: true,
    isBeside: isMirror,
    lead: words("calibration.step", { number, total }),
    title: words(`calibration.${step}.title`),
    body: texts.flatMap((text) => (text === null ? [] : [{ kind: "prose", text } as const])),
    problem: problem === null ? null : problemText(words, problem),
    ...(isHeld && {
      progress: { done: Math.ceil(held * TENTHS), of: TENTHS, text: measuring },
    }),
    ...buttonsOf(words, prompt),
  };
}

function buttonsOf(
  words: PanelWords,
  { step, canSkip }: CalibrationPrompt,
): { readonly buttons?: readonly PanelButton[] } {
  if (step === "mirror") {
    const bad = { target: "bad", text: words("calibration.mirror.bad"), side: "left" } as const;
    const good = { target: "good", text: words("calibration.mirror.good"), side: "right" } as const;
    return { buttons: [bad, { ...good, isPrimary: true }] };
  }
  if (!canSkip) return {};
  return { buttons: [{ target: "skip", text: words("calibration.skip"), side: "left" }] };
}
