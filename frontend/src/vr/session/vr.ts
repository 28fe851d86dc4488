/**
 * VR itself: the immersive session of WebXR, three's renderer, and the headset that they drive.
 *
 * One `Vr` lasts as long as the page. Its immersive session may end and be entered again any number
 * of times; the bodies, the phase and its record stay where they were, paused.
 */
import { PerspectiveCamera, WebGLRenderer } from "three";
import {
  type BodiesInWorker,
  type BodiesSetup,
  fetchBodiesBeforehand,
  openBodiesInWorker,
} from "../bodies";
import type { Measures } from "../calibration";
import { RoadLink, type RoadLinkOptions } from "../road";
import { layoutsOf } from "../tasks";
import type { TelemetryClient } from "../telemetry";
import {
  Boundary,
  ServerTrackers,
  type TrackedFrame,
  TrackerLink,
  type TrackingSource,
  WebXrTracking,
} from "../tracking";
import { armStretchOf } from "../tracking/skeleton";
import { paletteOf, STANDARD, World } from "../world";
import { loadModel, requestAvatars } from "./avatars";
import { SessionCompanion } from "./companion";
import { Headset } from "./headset";
import { drawIn, FRAME_RATE_HZ, requestImmersive } from "./immersive";
import type { Granted, Inspection } from "./inspection";
import { Pace } from "./pace";
import { deskOf } from "./panels/desk";
import { VisitPanels } from "./panels/visitPanels";
import { WorldScenery } from "./scenery";
import { socketUrl } from "./sockets";

export interface VrParts {
  readonly telemetry: TelemetryClient;
  readonly token: string;
  /** Whether the participant's fingers are recorded, as the client's hello said. */
  readonly withFingers: boolean;
  /** The immersive session has ended, whoever ended it. */
  readonly onEnd: () => void;
  readonly onFailure: (error: unknown) => void;
}

const NEAR_M = 0.05;
const FAR_M = 50;
/** A study with a road: its cars come from over a hundred metres. */
const STREET_FAR_M = 260;

export class Vr {
  readonly #parts: VrParts;
  readonly #renderer: WebGLRenderer;
  readonly #camera = new PerspectiveCamera(70, 1, NEAR_M, FAR_M);
  readonly #world: World;
  readonly #headset: Headset;
  readonly #panels: VisitPanels;
  readonly #tracking: WebXrTracking;
  readonly #lab = new ServerTrackers();
  readonly #companion: SessionCompanion;
  #labLink: TrackerLink | null = null;
  #bodies: BodiesInWorker | null = null;
  #screen: OnScreen | null = null;
  #session: XRSession | null = null;
  #granted: Granted | null = null;
  #boundary: Boundary | null = null;
  #guardedFrame = 0;
  #frames = 0;
  #statureM = 0;
  #armStretch = 1;
  #isRendering = true;

  constructor(parts: VrParts) {
    this.#parts = parts;
    const { telemetry, withFingers, onFailure } = parts;
    const { tasks, appearance, language, road } = telemetry.welcome;
    this.#renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
    this.#renderer.xr.enabled = true;
    this.#renderer.xr.setReferenceSpaceType("local-floor");
    const layouts = layoutsOf(tasks);
    const palette = appearance === undefined ? STANDARD : paletteOf(appearance);
    if (road !== undefined) {
      this.#camera.far = STREET_FAR_M;
      this.#camera.updateProjectionMatrix();
    }
    this.#world = new World({ layouts, palette, language, road });
    this.#companion = new SessionCompanion({ world: this.#world, token: parts.token, onFailure });
    this.#tracking = new WebXrTracking(
      {
        onSpace: (space) => {
          this.#renderer.xr.setReferenceSpace(space);
          this.#headset.calibrating.keepSquare(this.#tracking.roomFromSquare);
          // Seen from elsewhere from one frame to the next.
          this.#panels.cut();
          this.#panels.recentre();
        },
        onReset: (isKept) => this.#headset.recentred(isKept),
      },
      undefined,
      this.#lab,
    );
    this.#panels = new VisitPanels({
      telemetry,
      world: this.#world,
      desk: deskOf(parts.token),
      onCall: (what) => this.#headset.call(what),
      onCalibration: (target) => this.#headset.calibrating.press(target),
      onPressed: (side) => this.#pulse(side),
      isWorn: () => this.#screen === null,
      looksAround: () => this.#lab.wantsLookingAround,
    });
    this.#headset = new Headset({
      telemetry,
      guide: this.#panels,
      source: this.#tracking,
      keep: localStorage,
      onSquare: (worldFromSquare) => this.#tracking.moveSquare(worldFromSquare),
      openRoad: (phaseId, activeS, place) => openRoad(parts.token, { phaseId, activeS, place }),
      scenery: new WorldScenery(this.#world, [...layouts.keys()], () => this.#companion.link),
      prepareBodies: (measures, named) => this.#prepareBodies(measures, named),
      onBodyWorn: (body) => this.#wear(body),
      withFingers,
      onFailure,
    });
    const { keptSquare } = this.#headset.calibrating;
    if (keptSquare !== null) this.#tracking.restoreSquare(keptSquare);
    globalThis.reembody = this.#inspection();
    // The physics is the largest part of the page: it comes beside standby and calibration.
    void fetchBodiesBeforehand().catch(() => undefined);
  }

  get isShown(): boolean {
    return this.#session !== null;
  }

  /** Enter VR; call it in the handler of a click, in which browsers allow it. */
  async enter(): Promise<void> {
    // Also only allowed in the handler of a click.
    this.#world.sounds.resume();
    const session = await requestImmersive();
    this.#session = session;
    session.addEventListener("end", () => this.#ended(session));
    session.addEventListener("visibilitychange", () => this.#see(session));
    this.#see(session);
    this.#granted = await drawIn(this.#renderer, session, (timeMs, frame) =>
      this.#frame(timeMs, frame),
    );
    const space = this.#renderer.xr.getReferenceSpace();
    if (space !== null) this.#tracking.begin(session, space);
    this.#labLink ??= openTrackers(this.#parts.token, this.#lab);
    this.#companion.open();
    this.#boundary = await Boundary.of(session);
    this.#guardedFrame = 0;
  }

  /** Show the study on this screen instead of in VR, moved by a source of its own. */
  showOnScreen(
    host: HTMLElement,
    source: TrackingSource,
    onPace: (slowHz: number | null) => void = () => undefined,
  ): void {
    this.#world.sounds.resume();
    const screen = { host, source: new Watched(source), pace: new Pace(), onPace };
    this.#screen = screen;
    this.#headset.trackBy(screen.source);
    this.#companion.open();
    host.append(this.#renderer.domElement);
    this.#renderer.xr.enabled = false;
    this.#renderer.setAnimationLoop((timeMs) => this.#frameOnScreen(timeMs, screen));
  }

  /** End VR, if it is shown, and free what it used. */
  dispose(): void {
    void this.#session?.end().catch(() => undefined);
    this.#labLink?.close();
    this.#companion.close();
    this.#headset.dispose();
    this.#panels.dispose();
    this.#world.dispose();
    this.#renderer.setAnimationLoop(null);
    this.#renderer.domElement.remove();
    this.#renderer.dispose();
    this.#screen?.source.dispose();
    globalThis.reembody = undefined;
  }

  /** A short pulse of the controller that has pressed something, where it can. */
  #pulse(side: "left" | "right" | null): void {
    for (const { handedness, gamepad } of this.#session?.inputSources ?? []) {
      if (handedness !== side) continue;
      void gamepad?.hapticActuators?.[0]?.pulse?.(0.4, 20).catch(() => undefined);
    }
  }

  #frame(timeMs: number, frame: XRFrame): void {
    this.#guard(frame);
    this.#headset.frame(timeMs / 1000, frame);
    this.#frames++;
    if (this.#isRendering) this.#renderer.render(this.#world.scene, this.#camera);
  }

  /** Look at the guarded space once a second: it may move with the square, or be drawn anew. */
  #guard(frame: XRFrame): void {
    const { room } = this.#tracking;
    if (this.#boundary === null || room === null) return;
    const isNew = this.#guardedFrame === 0;
    if (this.#guardedFrame++ % FRAME_RATE_HZ !== 0) return;
    this.#panels.guard(this.#boundary.corners(frame, room.space), isNew);
  }

  #frameOnScreen(timeMs: number, { host, source, pace, onPace }: OnScreen): void {
    onPace(pace.note(timeMs / 1000));
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
      const halfHeight = Math.tan((this.#camera.fov * Math.PI) / 360);
      this.#panels.fitWindow(Math.atan(this.#camera.aspect * halfHeight));
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

  /** The participant sees the scene, or the device's own menu before it, or nothing of it. */
  #see(session: XRSession): void {
    if (this.#session !== session) return;
    // "visible-blurred" is the device's menu.
    if (session.visibilityState === "visible") this.#headset.lookAgain();
    else this.#headset.leave("asleep");
  }

  #wear(body: string | null): void {
    this.#world.wear(body, this.#statureM, this.#armStretch);
  }

  /** The bodies for this participant, and beside them the models that they are drawn with. */
  async #prepareBodies(measures: Measures, named: readonly string[]): Promise<BodiesInWorker> {
    const { telemetry, token, withFingers } = this.#parts;
    const { statureM, segmentsM } = measures;
    const { upper_arm: upperArmM = 0, forearm: forearmM = 0 } = segmentsM;
    const armM = upperArmM + forearmM;
    this.#statureM = statureM;
    this.#armStretch = armM > 0 ? armStretchOf(armM, statureM) : 1;
    this.#wear(null);
    if (telemetry.welcome.avatar !== "physics") {
      const surfaces = [...layoutsOf(telemetry.welcome.tasks).values()].flatMap(
        (layout) => layout.surfaces,
      );
      return this.#open({ avatar: "delayed_copy", statureM, segmentsM, surfaces, withFingers });
    }
    const avatars = await requestAvatars(token, measures, named);
    for (const [name, { humanoid, segments_m: armsM = {} }] of avatars) {
      // Drawn as a plain body until its model is there; a study is not held up by a picture.
      if (humanoid == null) continue;
      loadModel(token, humanoid).then(
        (model) => this.#world.addBody(name, model, armsM),
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
      epoch: telemetry.epoch,
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
      get calibration() {
        return vr.#headset.calibrating.prompt;
      },
      get granted() {
        return vr.#granted;
      },
      get computed() {
        return vr.#headset.computed;
      },
      get skippedGaps() {
        return vr.#bodies?.skippedGaps ?? 0;
      },
      get touchingParts() {
        return vr.#bodies?.touchingParts ?? [];
      },
      get frames() {
        return vr.#frames;
      },
      get recorded() {
        return vr.#headset.recorded;
      },
      get isIdle() {
        return vr.#bodies?.isIdle ?? true;
      },
      idle: async () => vr.#bodies?.idle(),
      get isRendering() {
        return vr.#isRendering;
      },
      set isRendering(isRendering: boolean) {
        vr.#isRendering = isRendering;
      },
      get panel() {
        return { ...vr.#panels.seen, targetsM: vr.#panels.targetsM };
      },
      get drawn() {
        const { calls, triangles } = vr.#renderer.info.render;
        return { calls, triangles };
      },
    };
  }
}

/** Open the socket over which the lab's trackers come to this headset. */
function openTrackers(token: string, trackers: ServerTrackers): TrackerLink {
  const url = socketUrl("/api/vr/trackers");
  return new TrackerLink({ url, token, trackers, clock: () => performance.now() / 1000 });
}

/** Open the socket over which the study's road comes to this headset. */
function openRoad(token: string, phase: Omit<RoadLinkOptions, "url" | "token">): RoadLink {
  return new RoadLink({ ...phase, url: socketUrl("/api/vr/road"), token });
}

/** The study on a screen: where it is drawn, and what moves the participant. */
interface OnScreen {
  readonly host: HTMLElement;
  readonly source: Watched;
  readonly pace: Pace;
  /** Called with every frame: the pictures a second if they are too few, else null. */
  readonly onPace: (slowHz: number | null) => void;
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
