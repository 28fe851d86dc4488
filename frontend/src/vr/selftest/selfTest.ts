/**
 * A test of the headset that runs it: two minutes in which the room, the body's physics, the
 * tracking and the sending of telemetry are those of a visit, and are measured.
 *
 * It has a renderer, a worker and a socket of its own and leaves the session alone: nothing of a
 * test is recorded there. A part that does not work is a finding of the test, not the end of it.
 */
import { PerspectiveCamera, WebGLRenderer } from "three";
import { type PanelScreen, Panels, StillContent } from "../panels";
import { drawIn, loadModel, requestImmersive, type SessionAvatar } from "../session";
import { layoutsOf } from "../tasks";
import type { Welcome } from "../telemetry";
import { type TrackedFrame, WebXrTracking } from "../tracking";
import { paletteOf, STANDARD, World } from "../world";
import { PageErrors } from "./errors";
import { givenName } from "./givenName";
import { Measurement } from "./measure/measurement";
import { PLAN, type PlanPlace, placeIn, planDurationS } from "./plan";
import { Preparation } from "./preparation";
import { LEAST_DURATION_S, type Report } from "./report";
import { type Progress, selfTestScreen } from "./screens";
import { Sending } from "./sending";
import { TestedBody, USUAL_STATURE_M } from "./testedBody";
import { type SelfTestWords, selfTestWords } from "./texts";

export interface SelfTestParts {
  readonly token: string;
  readonly welcome: Welcome;
  readonly language: string;
  /** Whether a visit on this device records fingers. */
  readonly withFingers: boolean;
  readonly onProgress: (progress: Progress) => void;
  /** The measurement has ended: keep the report, of which the last acknowledgements are missing. */
  readonly onMeasured: (report: Report) => void;
  /** The last acknowledgements have come or were given up: keep the report, send it, and tell with `delivered`. */
  readonly onReport: (report: Report) => void;
  /** It is not shown any more, whoever ended it. */
  readonly onEnd: () => void;
}

/** What a script sees of a running test: `globalThis.reembodyTest`, as `reembody` of a visit. */
export interface SelfTestInspection {
  readonly progress: Progress;
  readonly frames: number;
  /** Whether the bodies of every frame drawn so far are computed. */
  readonly isIdle: boolean;
  idle(): Promise<void>;
  isRendering: boolean;
  readonly panel: Pick<Panels, "targetsM"> & { readonly screen: PanelScreen };
  readonly drawn: { readonly calls: number; readonly triangles: number };
}

declare global {
  var reembodyTest: SelfTestInspection | undefined;
}

const NEAR_M = 0.05;
const FAR_M = 50;
/** A measurement without frames ends this long after its plan, s. */
const OVERDUE_S = 5;
const WATCH_EVERY_MS = 1000;
/** Neither devices nor boxes are drawn. */
const NOTHING = [] as const;

/** The page's monotonic clock, s. */
const nowS = (): number => performance.now() / 1000;

export class SelfTest {
  readonly #parts: SelfTestParts;
  readonly #words: SelfTestWords;
  readonly #renderer: WebGLRenderer;
  readonly #camera = new PerspectiveCamera(70, 1, NEAR_M, FAR_M);
  readonly #world: World;
  readonly #panels: Panels;
  readonly #content: StillContent;
  readonly #tracking: WebXrTracking;
  readonly #errors = new PageErrors();
  readonly #body = new TestedBody();
  #session: XRSession | null = null;
  #host: HTMLElement | null = null;
  #nominalHz: number | null = null;
  #sending: Sending | null = null;
  #preparation = new Preparation(nowS());
  #measuring: Measurement | null = null;
  #measuringSinceS = 0;
  #progress: Progress = this.#preparation.progress(nowS());
  /** Frames may not come at all, and somebody waits. */
  readonly #watch = setInterval(() => this.#look(), WATCH_EVERY_MS);
  /** The page follows whole seconds. */
  #toldS = 0;
  #isPlaced = false;
  #frames = 0;
  #isRendering = true;
  #isDisposed = false;

  constructor(parts: SelfTestParts) {
    this.#parts = parts;
    this.#words = selfTestWords(parts.language);
    const { tasks, appearance } = parts.welcome;
    this.#renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
    this.#renderer.xr.enabled = true;
    this.#renderer.xr.setReferenceSpaceType("local-floor");
    const palette = appearance === undefined ? STANDARD : paletteOf(appearance);
    this.#world = new World({ layouts: layoutsOf(tasks), palette, language: parts.language });
    this.#world.wear(null, USUAL_STATURE_M);
    this.#tracking = new WebXrTracking({
      onSpace: (space) => this.#renderer.xr.setReferenceSpace(space),
    });
    this.#panels = new Panels({ wallZM: this.#world.mirror.planeZM });
    this.#content = new StillContent(this.#screen, (target) => this.#press(target));
    this.#panels.onPressed = () => this.#world.sounds.play("press");
    this.#panels.show(this.#content);
    this.#world.panels.add(this.#panels.object);
    globalThis.reembodyTest = this.#inspection();
  }

  /** Run in VR; call it in the handler of a click, in which browsers allow it. */
  async enter(): Promise<void> {
    this.#world.sounds.resume();
    const session = await requestImmersive();
    this.#session = session;
    session.addEventListener("end", () => this.#left());
    const granted = await drawIn(this.#renderer, session, (timeMs, frame) =>
      this.#frame(timeMs / 1000, frame),
    );
    this.#nominalHz = granted.frameRateHz;
    const space = this.#renderer.xr.getReferenceSpace();
    if (space !== null) this.#tracking.begin(session, space);
    this.#prepare();
  }

  /** Run in a window on this screen, where a scripted person moves. */
  showOnScreen(host: HTMLElement): void {
    this.#host = host;
    host.append(this.#renderer.domElement);
    this.#renderer.xr.enabled = false;
    this.#renderer.setAnimationLoop((timeMs) => this.#frame(timeMs / 1000, null));
    this.#prepare();
  }

  /** End the measurement now; what was measured is reported if it is enough to say something. */
  stop(): void {
    const measuring = this.#measuring;
    if (measuring !== null) void this.#finish(measuring);
    else if (this.#progress.kind === "preparing") this.#become({ kind: "short" });
  }

  /** What became of the report: null while it could not be sent. */
  delivered(outcome: Progress & { readonly kind: "kept" | "stored" }): void {
    if (this.#progress.kind === "sending" || this.#progress.kind === "kept") this.#become(outcome);
  }

  /** End VR, if it is shown, and free what it used. */
  dispose(): void {
    if (this.#isDisposed) return;
    this.stop();
    this.#isDisposed = true;
    clearInterval(this.#watch);
    void this.#session?.end().catch(() => undefined);
    this.#errors.dispose();
    this.#body.dispose();
    // Its last batches may still be on their way to be acknowledged.
    if (this.#progress.kind !== "sending") this.#sending?.close();
    this.#tracking.dispose();
    this.#panels.dispose();
    this.#world.dispose();
    this.#renderer.setAnimationLoop(null);
    this.#renderer.domElement.remove();
    this.#renderer.dispose();
    globalThis.reembodyTest = undefined;
  }

  // Before.

  /** Load the body, if it is not there yet, and open a socket; the report says what failed. */
  #prepare(): void {
    const preparation = new Preparation(nowS());
    this.#preparation = preparation;
    const body = this.#body.isPrepared ? Promise.resolve() : this.#prepareBody();
    void body
      .catch((error: unknown) => this.#errors.note("physics", error))
      .then(() => preparation.settled("body"));
    void this.#prepareSending()
      .catch((error: unknown) => this.#errors.note("storage", error))
      .then(() => preparation.settled("sending"));
  }

  async #prepareBody(): Promise<void> {
    const { token, withFingers } = this.#parts;
    const avatar = await this.#body.prepare(token, withFingers);
    if (this.#isDisposed) return;
    this.#world.wear(null, avatar.stature_m);
    await this.#prepareFigure(avatar).catch((error: unknown) => this.#errors.note("figure", error));
  }

  /** The model that the session's body is drawn with; that of another avatar is drawn plainly. */
  async #prepareFigure({ humanoid }: SessionAvatar): Promise<void> {
    const { token, welcome } = this.#parts;
    if (humanoid == null || welcome.avatar !== "physics") return;
    this.#world.addBody(null, await loadModel(token, humanoid));
    await this.#world.prepare(this.#renderer, this.#camera);
  }

  async #prepareSending(): Promise<void> {
    const { protocol, host } = window.location;
    const { token, withFingers } = this.#parts;
    this.#sending = await Sending.open({
      url: `${protocol === "https:" ? "wss" : "ws"}://${host}/api/vr/self-tests/storage`,
      token,
      withFingers,
      clock: () => performance.now() / 1000,
      onError: (message) => this.#errors.note("storage", message),
    });
  }

  // While it runs.

  #frame(timeS: number, xr: XRFrame | null): void {
    this.#frames += 1;
    if (this.#host !== null) this.#fit(this.#host);
    const place = this.#placeAt(timeS);
    const worn = this.#tracking.read(timeS, xr);
    this.#stand(worn);
    const moved = this.#body.movedBy(worn, place?.movement ?? null);
    try {
      this.#body.follow(moved);
    } catch (error) {
      this.#errors.note("physics", error);
    }
    this.#measure(timeS, worn, moved);
    this.#say(place);
    this.#show(timeS, worn, moved, place);
    this.#panels.update(worn);
    if (this.#isRendering) this.#renderer.render(this.#world.scene, this.#camera);
    this.#advance(timeS, place);
  }

  /** Where the plan is; null before and after the measurement. */
  #placeAt(timeS: number): PlanPlace | null {
    return this.#measuring === null ? null : placeIn(PLAN, timeS - this.#measuring.startS);
  }

  /** The wearer stands where the test began, and looks at the mirror. */
  #stand({ eyes, parts }: TrackedFrame): void {
    if (this.#isPlaced || eyes === null || parts.Head.state !== "tracked") return;
    this.#isPlaced = true;
    this.#tracking.room?.recentreAt(eyes);
  }

  #measure(timeS: number, worn: TrackedFrame, moved: TrackedFrame): void {
    const measuring = this.#measuring;
    if (measuring === null) return;
    const computed = this.#body.latest;
    const kind = this.#body.kindOf(this.#tracking.kind);
    // On a screen nothing can be tracked: the scripted person is what a session there would have.
    const known = this.#host === null ? worn : moved;
    measuring.note({ timeS, worn: known, moved, kind, computed });
    const recorder = this.#sending?.recorder;
    if (computed === null || recorder === undefined) return;
    recorder.computed(computed);
    recorder.frame(timeS, computed, 0, false);
    recorder.send(timeS);
  }

  #say(place: PlanPlace | null): void {
    if (place === null) return;
    const progress = { kind: "measuring", place, isScripted: this.#body.isGuided } as const;
    this.#progress = progress;
    const screen = this.#screen;
    if (JSON.stringify(screen) !== JSON.stringify(this.#content.screen)) {
      this.#content.screen = screen;
    }
    const leftS = Math.ceil(place.leftS);
    if (leftS === this.#toldS) return;
    this.#toldS = leftS;
    this.#parts.onProgress(progress);
  }

  #show(timeS: number, worn: TrackedFrame, moved: TrackedFrame, place: PlanPlace | null): void {
    const bodies = this.#body.latest;
    const eyes = this.#host === null ? worn.eyes : moved.eyes;
    this.#world.show({
      timeS,
      eyes,
      bodies,
      visible: {
        local: false,
        remote: bodies !== null,
        figure: false,
        devices: false,
        setups: NOTHING,
      },
      devices: NOTHING,
      task: null,
      remainingS: place?.leftS ?? null,
      completed: null,
      isFrozen: false,
      isCurtainDrawn: false,
    });
    if (this.#host === null || eyes === null) return;
    const [w, x, y, z] = eyes.rotation;
    this.#camera.position.set(...eyes.positionM);
    this.#camera.quaternion.set(x, y, z, w);
  }

  /** Begin once everything is there, and end when the plan is done. */
  #advance(timeS: number, place: PlanPlace | null): void {
    if (this.#measuring !== null) {
      if (place === null) void this.#finish(this.#measuring);
      return;
    }
    const preparation = this.#preparation;
    const isBodyDue = preparation.missing.includes("body");
    if (!isBodyDue && (!this.#body.isPrepared || this.#body.latest !== null)) {
      preparation.settled("picture");
    }
    this.#begin(timeS);
  }

  #begin(timeS: number): void {
    const preparation = this.#preparation;
    if (this.#progress.kind !== "preparing" || !preparation.isOver(nowS())) return;
    for (const what of preparation.missing) {
      this.#errors.note("preparation", `not there after 30 s: ${what}`);
    }
    this.#measuringSinceS = nowS();
    this.#measuring = new Measurement(timeS, new Date());
  }

  /** Once a second, whether frames come or not: say how far it is, and wait for nothing for ever. */
  #look(): void {
    if (this.#session === null && this.#host === null) return;
    const measuring = this.#measuring;
    if (measuring !== null) {
      const isOverdue = nowS() - this.#measuringSinceS > planDurationS(PLAN) + OVERDUE_S;
      if (isOverdue) void this.#finish(measuring);
    } else if (this.#progress.kind === "preparing") {
      if (this.#preparation.isOver(nowS())) this.#begin(nowS());
      else this.#become(this.#preparation.progress(nowS()));
    }
  }

  // Afterwards.

  async #finish(measuring: Measurement): Promise<void> {
    this.#measuring = null;
    const { durationS, startS } = measuring;
    if (durationS < LEAST_DURATION_S) {
      this.#sending?.close();
      const hadTime = nowS() - this.#measuringSinceS >= LEAST_DURATION_S;
      this.#become({ kind: hadTime ? "unseen" : "short" });
      return;
    }
    this.#world.sounds.play("complete");
    this.#become({ kind: "sending" });
    const report = () =>
      measuring.report({
        userAgent: navigator.userAgent,
        name: givenName() || null,
        mode: this.#host === null ? "immersive" : "screen",
        nominalHz: this.#nominalHz,
        model: this.#model,
        storage: this.#sending?.figures ?? null,
        errors: this.#errors.lines,
      });
    const ended = this.#sending?.end(startS + durationS);
    // Who takes the headset off now loses the last acknowledgements, and not the test.
    this.#parts.onMeasured(report());
    await ended;
    this.#parts.onReport(report());
  }

  get #model() {
    const model = this.#body.model;
    return model && { model_hash: model.model_hash, stature_m: model.stature_m };
  }

  #press(target: string): void {
    if (target === "stop") this.stop();
    else if (target === "leave") this.#leave();
    else if (target === "again") this.#repeat();
  }

  #leave(): void {
    if (this.#session === null) this.#left();
    else void this.#session.end().catch(() => undefined);
  }

  /** Measure once more, with what is loaded already and a new socket. */
  #repeat(): void {
    this.#errors.forget();
    this.#prepare();
    this.#become(this.#preparation.progress(nowS()));
  }

  #left(): void {
    this.#session = null;
    this.#renderer.setAnimationLoop(null);
    this.stop();
    this.#parts.onEnd();
  }

  #become(progress: Progress): void {
    this.#progress = progress;
    this.#content.screen = this.#screen;
    this.#parts.onProgress(progress);
  }

  get #screen(): PanelScreen {
    return selfTestScreen(this.#words, this.#progress, this.#parts.language);
  }

  #fit({ clientWidth: width, clientHeight: height }: HTMLElement): void {
    const ratio = window.devicePixelRatio;
    const canvas = this.#renderer.domElement;
    const isFitting =
      canvas.width === Math.floor(width * ratio) && canvas.height === Math.floor(height * ratio);
    if (isFitting) return;
    this.#renderer.setPixelRatio(ratio);
    this.#renderer.setSize(width, height);
    this.#camera.aspect = width / Math.max(1, height);
    this.#camera.updateProjectionMatrix();
  }

  #inspection(): SelfTestInspection {
    const test = this;
    return {
      get progress() {
        return test.#progress;
      },
      get frames() {
        return test.#frames;
      },
      get isIdle() {
        return test.#body.isIdle;
      },
      idle: () => test.#body.idle(),
      get isRendering() {
        return test.#isRendering;
      },
      set isRendering(isRendering: boolean) {
        test.#isRendering = isRendering;
      },
      get panel() {
        return { targetsM: test.#panels.targetsM, screen: test.#content.screen };
      },
      get drawn() {
        const { calls, triangles } = test.#renderer.info.render;
        return { calls, triangles };
      },
    };
  }
}
