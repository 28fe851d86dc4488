/** Pictures of every panel in the headset's room, as one eye sees them; for tests only. */
import type { Administration } from "@shared/api/types";
import { openForms, StoredForms } from "@shared/forms/storedForms";
import { PerspectiveCamera, WebGLRenderer } from "three";
import { STANDARD, World } from "../../world";
import {
  boundaryScreen,
  calibrationScreen,
  comfortScreen,
  finishedScreen,
  type PanelContent,
  type PanelScreen,
  Panels,
  PauseRoom,
  panelWords,
  pauseScreen,
  Questionnaire,
  Reading,
  StillContent,
  StopGesture,
  StopRing,
  standbyScreen,
  takeOffScreen,
  waitingScreen,
} from "..";
import { frameOf, rayTo } from "./pointing";

/** 25 pixels a degree, as a Quest 3 shows. */
const VIEW = { widthPx: 1750, heightPx: 1500, upDeg: 60 } as const;
const EYES = [0, 1.62, 0.1] as const;
const HAND = [0.28, 1.15, -0.2] as const;

class Gallery {
  readonly world = new World({
    layouts: new Map(),
    palette: STANDARD,
    language: "en",
  });
  readonly panels = new Panels({ wallZM: this.world.mirror.planeZM });
  readonly pause = new PauseRoom();
  readonly renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  readonly camera = new PerspectiveCamera(VIEW.upDeg, VIEW.widthPx / VIEW.heightPx, 0.05, 50);
  timeS = 1;
  isPaused = false;
  ring: StopRing | null = null;

  constructor() {
    this.renderer.setSize(VIEW.widthPx, VIEW.heightPx, true);
    document.body.replaceChildren(this.renderer.domElement);
    document.body.style.margin = "0";
    this.world.panels.add(this.pause.object, this.panels.object);
    this.camera.position.set(...EYES);
    this.camera.rotation.x = -0.1;
  }

  /** Show a content, point at a target (or nothing), and draw. Returns what can be pressed. */
  draw(content: PanelContent | null, pointAt: string | null, seconds = 1): readonly string[] {
    this.panels.show(content);
    for (let frame = 0; frame < 3; frame += 1) {
      this.timeS += seconds / 3;
      const target = this.panels.targetsM.find((one) => one.target === pointAt);
      const ray = target === undefined ? null : rayTo(HAND, target.atM);
      const tracked = frameOf({ timeS: this.timeS, eyesM: EYES, right: { ray } });
      this.panels.update(tracked);
      this.pause.show(this.timeS, this.isPaused);
      this.world.show({
        timeS: this.timeS,
        eyes: tracked.eyes,
        bodies: null,
        visible: { local: false, remote: false, figure: false, devices: false, setups: [] },
        devices: [],
        task: null,
        remainingS: null,
        completed: null,
        isFrozen: false,
        isCurtainDrawn: this.isPaused,
      });
    }
    this.renderer.render(this.world.scene, this.camera);
    return this.panels.targetsM.map(({ target }) => target);
  }

  screens(language: string): Readonly<Record<string, PanelScreen>> {
    const words = panelWords(language);
    const prompt = {
      total: 6,
      held: 0,
      secondsLeft: 1,
      problem: null,
      again: null,
      canSkip: false,
    } as const;
    return {
      standby: standbyScreen(words, true),
      waiting: waitingScreen(words, null, null),
      take_off: takeOffScreen(words, false),
      take_off_form: takeOffScreen(words, true),
      finished: finishedScreen(words),
      comfort: comfortScreen(words),
      boundary_near: boundaryScreen(words, { kind: "near" }),
      boundary_small: boundaryScreen(words, { kind: "small", haveM: [1.5, 1.2], needM: [2, 2.1] }),
      square: calibrationScreen(words, {
        ...prompt,
        step: "square",
        number: 1,
        problem: { kind: "off_square", towards: "forward", distanceM: 0.32 },
      }),
      n_pose: calibrationScreen(words, {
        ...prompt,
        step: "n_pose",
        number: 2,
        problem: { kind: "arms_not_down" },
        again: { kind: "bent_knees" },
      }),
      t_pose: calibrationScreen(words, { ...prompt, step: "t_pose", number: 3, held: 0.6 }),
      t_pose_unseen: calibrationScreen(words, {
        ...prompt,
        step: "t_pose",
        number: 3,
        problem: { kind: "lost", part: "LeftHand" },
        again: { kind: "goal_error", part: "RightLowerLeg", errorM: 0.042 },
        canSkip: true,
      }),
      squat: calibrationScreen(words, { ...prompt, step: "squat", number: 4 }),
      reach: calibrationScreen(words, {
        ...prompt,
        step: "reach",
        number: 5,
        problem: { kind: "not_reached" },
      }),
      mirror: calibrationScreen(words, {
        ...prompt,
        step: "mirror",
        number: 6,
        held: 0.3,
        secondsLeft: 6,
      }),
    };
  }

  still(language: string, name: string, pointAt: string | null): readonly string[] {
    const screen = this.screens(language)[name];
    if (screen === undefined) throw new Error(`no screen ${name}`);
    return this.draw(new StillContent(screen), pointAt);
  }

  paused(language: string, by: "operator" | "participant"): readonly string[] {
    this.isPaused = true;
    const words = panelWords(language);
    const pause = by === "operator" ? { by } : ({ by, call: "told" } as const);
    const targets = this.draw(new StillContent(pauseScreen(words, pause)), null, 3);
    this.isPaused = false;
    return targets;
  }

  stopping(language: string): void {
    this.ring ??= new StopRing(panelWords(language));
    this.world.panels.add(this.ring.object);
    const gesture = new StopGesture();
    for (const timeS of [0, 0.3, 0.66]) {
      const frame = frameOf({ timeS, eyesM: EYES, parts: { RightHand: [0.2, 2, 0] } });
      this.ring.update(frame, gesture.update(frame));
    }
    this.draw(null, null);
    this.ring.object.visible = false;
  }

  reading(language: string, title: string, text: string, page: number): readonly string[] {
    const words = panelWords(language);
    const { measure } = this.panels;
    const onRead = () => {};
    const reading = new Reading({ title, text, words, measure, onRead, onAsk: onRead });
    for (let turned = 0; turned < page; turned += 1) reading.press("next");
    return this.draw(reading, page === 0 ? "next" : null);
  }

  /** Every screen of a form on the way through its questions: title and how much the panel grew. */
  async form(language: string, administration: Administration, pages: readonly string[]) {
    const form = await Questionnaire.open({
      sessionId: "gallery",
      administration: {
        ...administration,
        key: `${administration.key} ${language} ${Math.random()}`,
      },
      language,
      words: panelWords(language),
      store: new StoredForms(openForms("gallery")),
      submit: () => Promise.reject(new Error("a gallery sends nothing")),
      onSettled: () => {},
      clock: { monotonicMs: () => performance.now(), now: () => new Date() },
      later: () => {},
    });
    for (const target of pages) form.press(target, performance.now());
    return form;
  }

  async formPage(
    language: string,
    administration: Administration,
    pages: readonly string[],
    pointAt: string | null,
  ): Promise<readonly string[]> {
    return this.draw(await this.form(language, administration, pages), pointAt);
  }
}

declare global {
  var gallery: Gallery;
}

globalThis.gallery = new Gallery();
