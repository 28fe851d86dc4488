/** Screens that tell the participant something: wait, take the headset off, a break, the edge. */
import type { Paragraph } from "@shared/text";
import type { PanelScreen } from "../surface/screen";
import type { PanelWords } from "../texts";

const prose = (...texts: readonly string[]): readonly Paragraph[] =>
  texts.map((text) => ({ kind: "prose", text }));

/** A title, some sentences, and something to know beside a sign; empty sentences are left out. */
export const prompt = (
  key: string,
  title: string | undefined,
  texts: readonly string[],
  problem: string | null = null,
): PanelScreen => ({
  key,
  ...(title === undefined ? {} : { title }),
  body: prose(...texts.filter((text) => text !== "")),
  problem,
});

/** Connected, and nothing has begun. */
export const standbyScreen = (words: PanelWords, holdsControllers: boolean): PanelScreen => ({
  key: "standby",
  title: words("standby.title"),
  body: prose(
    words("standby.body"),
    words(holdsControllers ? "standby.stop" : "standby.stopHands"),
  ),
});

/** Not paired, or no longer. */
export const pairingScreen = (words: PanelWords): PanelScreen => ({
  key: "pairing",
  title: words("pairing.title"),
  body: prose(words("pairing.body")),
});

export const offlineScreen = (words: PanelWords): PanelScreen => ({
  key: "offline",
  title: words("offline.title"),
  body: prose(words("offline.body")),
});

/** Nothing to do; the step's own words, if it has any. */
export const waitingScreen = (
  words: PanelWords,
  title: string | null,
  text: string | null,
): PanelScreen => ({
  key: "waiting",
  title: title ?? words("waiting.title"),
  body: prose(text ?? words("waiting.body")),
});

/** The next part is outside the headset; `isForm`: it is a form on the tablet. */
export const takeOffScreen = (words: PanelWords, isForm: boolean): PanelScreen => ({
  key: "take off",
  title: words("takeOff.title"),
  body: prose(words(isForm ? "takeOff.form" : "takeOff.body"), words("takeOff.told")),
});

export const finishedScreen = (words: PanelWords): PanelScreen => ({
  key: "finished",
  title: words("finished.title"),
  body: prose(words("finished.body")),
});

/**
 * The pause room's words. `participant`: somebody stopped by a gesture, and the call is under way
 * (`telling`), has arrived (`told`), or could not be sent (`untold`); `operator`: the experimenter
 * paused.
 */
export type Pause =
  | { readonly by: "operator" }
  | { readonly by: "participant"; readonly call: "telling" | "told" | "untold" };

export function pauseScreen(words: PanelWords, pause: Pause): PanelScreen {
  const resume = words("pause.resume");
  if (pause.by === "operator") {
    const body = prose(words("pause.operator.body"), resume);
    return { key: "pause operator", title: words("pause.operator.title"), body };
  }
  const said = { telling: "pause.telling", told: "pause.body", untold: "pause.untold" } as const;
  return {
    key: `pause ${pause.call}`,
    title: words("pause.title"),
    ...(pause.call === "untold"
      ? { body: prose(words("comfort.body"), resume), problem: words("pause.untold") }
      : { body: prose(words(said[pause.call]), resume) }),
  };
}

/** A question about comfort, between phases or after a stop. */
export const comfortScreen = (words: PanelWords): PanelScreen => ({
  key: "comfort",
  title: words("comfort.title"),
  body: prose(words("comfort.body")),
});

/** What is wrong with the play area; sizes in metres, width by depth. */
export type BoundaryProblem =
  | { readonly kind: "near" | "missing" }
  | {
      readonly kind: "small";
      readonly haveM: readonly [number, number];
      readonly needM: readonly [number, number];
    };

export function boundaryScreen(words: PanelWords, problem: BoundaryProblem): PanelScreen {
  const title = words("boundary.title");
  switch (problem.kind) {
    case "near":
      return { key: "boundary near", title, problem: words("boundary.body") };
    case "missing":
      return {
        key: "boundary missing",
        title: words("boundary.area"),
        problem: words("boundary.missing"),
      };
    case "small": {
      const [[haveM, haveDepthM], [needM, needDepthM]] = [problem.haveM, problem.needM];
      const metres = (value: number) => value.toFixed(1).replace(".", words("decimal"));
      const sizes = {
        haveM: metres(haveM),
        haveDepthM: metres(haveDepthM),
        needM: metres(needM),
        needDepthM: metres(needDepthM),
      };
      const area = words("boundary.area");
      return { key: "boundary small", title: area, problem: words("boundary.small", sizes) };
    }
  }
}
