/**
 * VR itself: the immersive session of WebXR, three's renderer, and the headset that they drive.
 *
 * One `Vr` lasts as long as the page. Its immersive session may end and be entered again any number
 * of times; the bodies, the phase and its record stay where they were, paused.
 */
import { PerspectiveCamera, WebGLRenderer } from "three";
import { type BodiesInWorker, type BodiesSetup, openBodiesInWorker } from "../bodies";
import { layoutsOf } from "../tasks";
import type { TelemetryClient } from "../telemetry";
import { type TrackedFrame, type TrackingSource, WebXrTracking } from "../tracking";
import { paletteOf, STANDARD, World } from "../world";
import { loadModel, requestAvatars } from "./avatars";
import { Headset } from "./headset";
import type { Granted, Inspection } from "./inspection";
import { WorldScenery } from "./scenery";
import { UsualOffsets } from "./usualOffsets";

export interface VrParts {
  readonly telemetry: TelemetryClient;
  readonly token: string;
  /** Whether the participant's fingers are recorded, as the client's hello said. */
  readonly withFingers: boolean;
  /** The immersive session has ended, whoever ended it. */
  readonly onEnd: () => void;
  readonly onFailure: (error: unknown) => void;
}

/** 90 Hz is what the recording and the study's bodies are made for. */
const FRAME_RATE_HZ = 90;
/** Browsers may never answer a request for a frame rate. */
const PATIENCE_MS = 2000;
/** three's own default is the most, which blurs text and hands at the edge of the view. */
const FOVEATION = 0.3;
const NEAR_M = 0.05;
const FAR_M = 50;

const REQUIRED = ["local-floor"] as const;
const OPTIONAL = ["hand-tracking", "bounded-floor", "body-tracking", "tracked-sources"] as const;

export class Vr {
  readonly #parts: VrParts;
  readonly #renderer: WebGLRenderer;
  readonly #camera = new PerspectiveCamera(70, 1, NEAR_M, FAR_M);
  readonly #world: World;
  readonly #headset: Headset;
  readonly #tracking: WebXrTracking;
  readonly #calibrator = new UsualOffsets();
  #bodies: BodiesInWorker | null = null;
  #screen: OnScreen | null = null;
  #session: XRSession | null = null;
  #granted: Granted | null = null;
  #frames = 0;
  #statureM = 0;
  #isRendering = true;

  constructor(parts: VrParts) {
    this.#parts = parts;
    const { telemetry, withFingers, onFailure } = parts;
    const { tasks, appearance, language } = telemetry.welcome;
    this.#renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
    this.#renderer.xr.enabled = true;
    this.#renderer.xr.setReferenceSpaceType("local-floor");
    const layouts = layoutsOf(tasks);
    const palette = appearance === undefined ? STANDARD : paletteOf(appearance);
    this.#world = new World({ layouts, palette, language });
    this.#tracking = new WebXrTracking({
      onSpace: (space) => this.#renderer.xr.setReferenceSpace(space),
      onReset: () => this.#headset.stop("recentred"),
    });
    this.#headset = new Headset({
      telemetry,
      source: this.#tracking,
      calibrator: this.#calibrator,
      scenery: new WorldScenery(this.#world, [...layouts.keys()]),
      prepareBodies: (statureM, named) => this.#prepareBodies(statureM, named),
      onBodyWorn: (body) => this.#world.wear(body, this.#statureM),
      withFingers,
      onFailure,
    });
    globalThis.reembody = this.#inspection();
  }

  get isShown(): boolean {
    return this.#session !== null;
  }

  /** Enter VR; call it in the handler of a click, in which browsers allow it. */
  async enter(): Promise<void> {
    const xr = navigator.xr;
    if (xr === undefined) throw new Error("This browser has no WebXR.");
    // Also only allowed in the handler of a click.
    this.#world.sounds.resume();
    const session = await xr.requestSession("immersive-vr", {
      requiredFeatures: [...REQUIRED],
      optionalFeatures: [...OPTIONAL],
    });
    this.#session = session;
    session.addEventListener("end", () => this.#ended(session));
    session.addEventListener("visibilitychange", () => {
      if (session.visibilityState !== "visible") this.#headset.leave("asleep");
    });
    await requestFrameRate(session);
    // Before the session is set: later it would start the window's loop beside the session's.
    this.#renderer.setAnimationLoop((timeMs, frame) => {
      if (frame !== undefined) this.#frame(timeMs, frame);
    });
    await this.#renderer.xr.setSession(session);
    this.#renderer.xr.setFoveation(FOVEATION);
    this.#granted = {
      features: session.enabledFeatures ?? [],
      frameRateHz: session.frameRate ?? null,
      foveation: this.#renderer.xr.getFoveation() ?? null,
    };
    const space = this.#renderer.xr.getReferenceSpace();
    if (space !== null) this.#tracking.begin(session, space);
  }

  /** Show the study on this screen instead of in VR, moved by a source of its own. */
  showOnScreen(host: HTMLElement, source: TrackingSource): void {
    this.#world.sounds.resume();
    const screen = { host, source: new Watched(source) };
    this.#screen = screen;
    this.#headset.trackBy(screen.source);
    host.append(this.#renderer.domElement);
    this.#renderer.xr.enabled = false;
    this.#renderer.setAnimationLoop((timeMs) => this.#frameOnScreen(timeMs, screen));
  }

  /** End VR, if it is shown, and free what it used. */
  dispose(): void {
    void this.#session?.end().catch(() => undefined);
    this.#headset.dispose();
    this.#world.dispose();
    this.#renderer.setAnimationLoop(null);
    this.#renderer.domElement.remove();
    this.#renderer.dispose();
    this.#screen?.source.dispose();
    globalThis.reembody = undefined;
  }

  #frame(timeMs: number, frame: XRFrame): void {
    this.#headset.frame(timeMs / 1000, frame);
    this.#frames++;
    if (this.#isRendering) this.#renderer.render(this.#world.scene, this.#camera);
  }

  #frameOnScreen(timeMs: number, { host, source }: OnScreen): void {
    const { clientWidth: width, clientHeight: height } = host;
    const canvas = this.#renderer.domElement;
    const ratio = window.devicePixelRatio;
    if (
      canvas.width !== Math.floor(width * ratio) ||
      canvas.height !== Math.floor(height * ratio)
    ) {
      this.#renderer.setPixelRatio(ratio);
      this.#renderer.setSize(width, height);
      this.#camera.aspect = width / Math.max(1, height);
      this.#camera.updateProjectionMatrix();
    }
    this.#headset.frame(timeMs / 1000, null);
    this.#frames++;
    const eyes = source.last?.eyes ?? null;
    if (eyes !== null) {
      const [w, x, y, z] = eyes.rotation;
      this.#camera.position.set(...eyes.positionM);
      this.#camera.quaternion.set(x, y, z, w);
    }
    if (this.#isRendering) this.#renderer.render(this.#world.scene, this.#camera);
  }

  #ended(session: XRSession): void {
    if (this.#session !== session) return;
    this.#session = null;
    this.#renderer.setAnimationLoop(null);
    this.#headset.leave("asleep");
    void this.#parts.telemetry.flush().catch(() => undefined);
    this.#parts.onEnd();
  }

  /** The bodies for this participant, and beside them the models that they are drawn with. */
  async #prepareBodies(statureM: number, named: readonly string[]): Promise<BodiesInWorker> {
    const { telemetry, token, withFingers } = this.#parts;
    this.#statureM = statureM;
    this.#calibrator.scaleTo(statureM);
    this.#world.wear(null, statureM);
    if (telemetry.welcome.avatar !== "physics") {
      const surfaces = [...layoutsOf(telemetry.welcome.tasks).values()].flatMap(
        (layout) => layout.surfaces,
      );
      return this.#open({ avatar: "delayed_copy", statureM, surfaces, withFingers });
    }
    const avatars = await requestAvatars(token, statureM, named);
    for (const [name, { humanoid }] of avatars) {
      // Drawn as a plain body until its model is there; a study is not held up by a picture.
      if (humanoid == null) continue;
      loadModel(token, humanoid).then(
        (model) => this.#world.addBody(name, model),
        this.#parts.onFailure,
      );
    }
    const [own, ...others] = avatars.values();
    if (own === undefined) throw new Error("The session has no avatar.");
    const listed = [own, ...others] as const;
    return this.#open({ avatar: "physics", bodies: listed, withFingers });
  }

  /** In a worker, whose own script may make functions from text as MuJoCo does; this page may not. */
  async #open(setup: BodiesSetup): Promise<BodiesInWorker> {
    this.#bodies = await openBodiesInWorker(setup);
    return this.#bodies;
  }

  #inspection(): Inspection {
    const vr = this;
    const { telemetry } = this.#parts;
    return {
      get state() {
        return telemetry.state;
      },
      get status() {
        return telemetry.status;
      },
      get place() {
        return vr.#headset.place;
      },
      get run() {
        return vr.#headset.run;
      },
      get granted() {
        return vr.#granted;
      },
      get frames() {
        return vr.#frames;
      },
      get isIdle() {
        return vr.#bodies?.isIdle ?? true;
      },
      get isRendering() {
        return vr.#isRendering;
      },
      set isRendering(isRendering: boolean) {
        vr.#isRendering = isRendering;
      },
      get drawn() {
        const { calls, triangles } = vr.#renderer.info.render;
        return { calls, triangles };
      },
    };
  }
}

/** The study on a screen: where it is drawn, and what moves the participant. */
interface OnScreen {
  readonly host: HTMLElement;
  readonly source: Watched;
}

/** A source whose newest frame the camera also follows. */
class Watched implements TrackingSource {
  last: TrackedFrame | null = null;
  readonly #of: TrackingSource;

  constructor(of: TrackingSource) {
    this.#of = of;
  }

  get kind() {
    return this.#of.kind;
  }

  get measures() {
    return this.#of.measures;
  }

  get knownBody() {
    return this.#of.knownBody;
  }

  read(timeS: number, frame: XRFrame | null): TrackedFrame {
    this.last = this.#of.read(timeS, frame);
    return this.last;
  }

  dispose(): void {
    this.#of.dispose();
  }
}

/** Ask for the study's frame rate where the device can choose; it may still draw at another. */
async function requestFrameRate(session: XRSession): Promise<void> {
  if (session.updateTargetFrameRate === undefined) return;
  if (!session.supportedFrameRates?.includes(FRAME_RATE_HZ)) return;
  const patience = new Promise<void>((resolve) => {
    setTimeout(resolve, PATIENCE_MS);
  });
  const asked = session.updateTargetFrameRate(FRAME_RATE_HZ).catch(() => undefined);
  await Promise.race([asked, patience]);
}
