/**
 * A page for tests and benchmarks: the room in an emulated headset, in scenes that a script asks for.
 *
 * `window.room.open(...)` builds a world and enters immersive VR; `window.room.draw(...)` shows one
 * moment to both eyes and returns the picture and what drawing it took.
 */
import { type Quaternion, rotate, type Vector } from "@shared/rotations";
import type { BodyBinding } from "@shared/stage/skin/pose";
import type { Camera, Vector3 } from "three";
import type { PanelScreen } from "../panels";
import type { BodyValues, Visible, World } from "../world";
import { EmulatedHeadset } from "./emulatedHeadset";
import { installVirtualClock } from "./virtualClock";

const clock = installVirtualClock();
const headset = new EmulatedHeadset();

// Both must be there before three.js is imported.
const THREE = await import("three");
const { Reflector } = await import("three/addons/objects/Reflector.js");
const { readBody } = await import("@shared/stage/skin/readBody");
const { BodyEyes, paletteOf, World: WorldOf } = await import("../world");
const { JOINTS, tPose } = await import("../world/skeleton");
const tasksOf = await import("../tasks");
const { Panels, PauseRoom, panelWords, pauseScreen, StillContent, StopRing } = await import(
  "../panels"
);
const { frameOf, rayTo } = await import("../panels/testing/pointing");

interface Options {
  readonly tasks: unknown;
  readonly appearance: unknown;
  readonly palette: string;
  readonly language: string;
  readonly statureM: number;
  /** The model of the bodies: its file in base 64; null for the plain body. */
  readonly body: { readonly file: string; readonly binding: BodyBinding } | null;
  /** `reflector` is three's own mirror, to compare with. */
  readonly mirror: "double" | "reflector";
  readonly sizePx: readonly [width: number, height: number];
}

/** Rotations of joints about axes of the T-pose in degrees, one after the other. */
type PoseDeg = Readonly<Record<string, readonly (readonly [axis: "x" | "y" | "z", deg: number])[]>>;

interface Moment {
  readonly pose: PoseDeg;
  /** How far the body has turned and moved; degrees and metres. */
  readonly turnDeg?: number;
  readonly movedM?: Vector;
  /** How the head and so the eyes are turned: down is negative, to the left positive; degrees. */
  readonly lookDeg?: { readonly pitch: number; readonly yaw: number };
  readonly visible: Visible;
  readonly task?: {
    readonly limb: "hand" | "foot";
    readonly goal: string | null;
    readonly green: readonly string[];
    readonly red: readonly string[];
    readonly numbers: readonly number[];
  };
  readonly remainingS?: number;
  readonly completed?: number;
  readonly isFrozen?: boolean;
  readonly isCurtainDrawn?: boolean;
  /** Frames that pass with it before the picture; 1 by default. */
  readonly frames?: number;
  readonly controllers?: boolean;
  /** A question that a ray points at, or with a stop on its way; or the pause room. */
  readonly panel?: "question" | "stopping" | "pause" | null;
  readonly isBoundarySmall?: boolean;
  /** Another person of the same body stands there in the same pose; metres. */
  readonly companionAtM?: Vector;
  /** Look from here instead of through the body's eyes. */
  readonly from?: { readonly positionM: Vector; readonly rotation: Quaternion };
}

interface Drawn {
  /** Draw calls and triangles an eye, as three.js counts them. */
  readonly calls: number;
  readonly triangles: number;
  /** Changes of the framebuffer between the first and the last draw call of the frame. */
  readonly targetSwitches: number;
  /** The middle of the head, and of its reflection, in the picture of each eye; pixels. */
  readonly headPx: readonly Pixel[];
  readonly reflectedHeadPx: readonly Pixel[];
  readonly png: string;
}

type Pixel = readonly [x: number, y: number];

let world: World | null = null;
let draw: ((moment: Moment) => Drawn) | null = null;

async function open(options: Options): Promise<void> {
  const { sizePx, statureM, body, mirror } = options;
  const layouts = tasksOf.layoutsOf(options.tasks);
  const palette = paletteOf(options.appearance, options.palette);
  const made = new WorldOf({
    layouts,
    palette,
    language: options.language,
    hasDouble: mirror === "double",
  });
  world = made;
  if (body !== null) {
    const bytes = Uint8Array.from(atob(body.file), (one) => one.charCodeAt(0));
    const model = await readBody(bytes.buffer, body.binding);
    made.addBody(null, model);
    made.companion.be(statureM, model);
  } else made.companion.be(statureM, null);
  made.wear(null, statureM);
  if (mirror === "reflector") addReflector(made);

  const panels = panelsOf(made, options.language);
  const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
  renderer.setSize(...sizePx);
  renderer.xr.enabled = true;
  renderer.xr.setReferenceSpaceType("local-floor");
  renderer.xr.setFoveation(0);
  document.body.append(renderer.domElement);
  const watch = watchTargets(renderer.getContext());
  const camera = new THREE.PerspectiveCamera(70, 1, 0.05, 30);
  const hips = body === null ? 0.545 * statureM : hipsOf(body.binding, statureM);
  const eyes = new BodyEyes(statureM, body?.binding);

  let moment: Moment | null = null;
  renderer.setAnimationLoop((timeMs, frame) => {
    if (!frame || moment === null) return;
    const { visible, task } = moment;
    const values = poseValues(moment, hips);
    const bodies: BodyValues = {
      local: values,
      remote: values,
      localFingers: null,
      remoteFingers: null,
    };
    made.show({
      timeS: timeMs / 1000,
      eyes: moment.from ?? { positionM: eyes.positionM, rotation: eyes.rotation },
      bodies,
      visible,
      devices: moment.controllers === true ? CONTROLLERS : [],
      task: task === undefined ? null : shownTask(task, layouts),
      remainingS: moment.remainingS ?? null,
      completed: moment.completed ?? null,
      companion:
        moment.companionAtM === undefined
          ? null
          : poseValues({ ...moment, movedM: moment.companionAtM }, hips),
      isFrozen: moment.isFrozen ?? false,
      isCurtainDrawn: moment.isCurtainDrawn ?? false,
    });
    panels(timeMs / 1000, moment.panel ?? null, eyes.positionM);
    watch.begin();
    renderer.render(made.scene, camera);
    watch.end();
  });
  const session = await navigator.xr?.requestSession("immersive-vr", {
    requiredFeatures: ["local-floor"],
  });
  if (session === undefined) throw new Error("The emulated headset has no session.");
  await renderer.xr.setSession(session);

  draw = (next) => {
    moment = next;
    if (next.isBoundarySmall === true) made.checkBoundary([]);
    else made.hideBoundary();
    eyes.place(poseValues(next, hips));
    headset.setEyes(next.from ?? { positionM: eyes.positionM, rotation: eyes.rotation });
    for (let frame = 0; frame < (next.frames ?? 1); frame++) clock.step();
    const { calls, triangles } = renderer.info.render;
    const png = renderer.domElement.toDataURL("image/png").split(",")[1] ?? "";
    const head = new THREE.Vector3(...eyes.positionM);
    const cameras = renderer.xr.getCamera().cameras;
    const pixels = (point: Vector3) => cameras.map((eye, at) => pixelOf(point, eye, at, sizePx));
    return {
      calls: calls / 2,
      triangles: triangles / 2,
      targetSwitches: watch.switches,
      headPx: pixels(head),
      reflectedHeadPx: pixels(made.mirror.reflectPoint(head.clone())),
      png,
    };
  };
}

/** What the visit draws beside the room: a panel with a ray on it, the ring of a stop, the pause room. */
function panelsOf(made: World, language: string) {
  const words = panelWords(language);
  const panels = new Panels({ wallZM: made.mirror.planeZM });
  const ring = new StopRing(words);
  const pauseRoom = new PauseRoom();
  made.panels.add(pauseRoom.object, panels.object, ring.object);
  const contents = {
    question: new StillContent(QUESTION),
    stopping: new StillContent(QUESTION),
    pause: new StillContent(pauseScreen(words, { by: "participant", call: "told" })),
  };
  return (timeS: number, shown: NonNullable<Moment["panel"]> | null, eyesM: Vector): void => {
    panels.show(shown === null ? null : contents[shown]);
    const target = panels.targetsM[2];
    const ray = target === undefined ? null : rayTo([0.28, 1.15, -0.2], target.atM);
    const tracked = frameOf({ timeS, eyesM, right: { ray } });
    panels.update(tracked, shown !== "stopping");
    ring.update(tracked, shown === "stopping" ? { share: 0.6, by: "hand" } : null);
    pauseRoom.show(timeS, shown === "pause");
  };
}

const QUESTION: PanelScreen = {
  key: "question",
  lead: "During the experiment there were moments in which...",
  title: "I felt as if the virtual body was my body.",
  isQuestion: true,
  choices: {
    layout: "rows",
    items: [1, 2, 3, 4, 5, 6, 7].map((value) => ({
      target: `answer ${value}`,
      text: `answer ${value}`,
    })),
  },
  progress: { done: 1, of: 15, text: "1" },
  buttons: [{ target: "next", text: "Next", side: "right", isPrimary: true }],
};

/** Where a point of the world is in the picture, in which the eyes' halves are side by side. */
function pixelOf(
  point: Vector3,
  eye: Camera,
  index: number,
  [width, height]: readonly [width: number, height: number],
): Pixel {
  const seen = point.clone().project(eye);
  return [(width / 2) * (index + 0.5 + seen.x / 2), height * (0.5 - seen.y / 2)];
}

/** three's mirror in the hole of the wall; it sees the head, which the eyes do not. */
function addReflector(made: World): void {
  const { widthM, heightM, planeZM } = made.mirror;
  const glass = new Reflector(new THREE.PlaneGeometry(widthM, heightM), {
    textureWidth: 1024,
    textureHeight: 1024,
    multisample: 0,
    // What it is multiplied by: 0.5 changes nothing.
    color: new THREE.Color().setRGB(0.5, 0.5, 0.5),
  });
  glass.position.set(0, heightM / 2, planeZM);
  const reflect = glass.onBeforeRender.bind(glass);
  glass.onBeforeRender = (...given) => {
    made.isSeenFromWithin = false;
    reflect(...given);
    made.isSeenFromWithin = true;
  };
  made.scene.add(glass);
}

/** Count changes of the framebuffer between draw calls: what is bound before and after is free. */
function watchTargets(gl: WebGLRenderingContext | WebGL2RenderingContext) {
  let target: WebGLFramebuffer | null = null;
  let drawn: WebGLFramebuffer | null | undefined;
  const counted = { switches: 0, isOn: false };
  const bind = gl.bindFramebuffer.bind(gl);
  gl.bindFramebuffer = (kind, framebuffer) => {
    target = framebuffer;
    bind(kind, framebuffer);
  };
  const count = () => {
    if (counted.isOn && drawn !== undefined && drawn !== target) counted.switches++;
    drawn = target;
  };
  for (const name of DRAWING) {
    const own = Reflect.get(gl, name);
    if (typeof own !== "function") continue;
    Reflect.set(gl, name, (...given: unknown[]) => {
      count();
      return Reflect.apply(own, gl, given);
    });
  }
  return {
    get switches() {
      return counted.switches;
    },
    begin() {
      counted.switches = 0;
      counted.isOn = true;
      drawn = undefined;
    },
    end() {
      counted.isOn = false;
    },
  };
}
const DRAWING = ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"];

const hipsOf = ({ joints_m, stature_m }: BodyBinding, statureM: number): number =>
  ((joints_m[0]?.[1] ?? 0) * statureM) / stature_m;

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] } as const;

function poseValues({ pose, turnDeg = 0, movedM, lookDeg }: Moment, hipsM: number): Float32Array {
  const values = tPose(hipsM);
  const turned = lookDeg === undefined ? pose : { ...pose, Head: headTurns(lookDeg) };
  const rotation = new THREE.Quaternion();
  const more = new THREE.Quaternion();
  for (const [joint, turns] of Object.entries(turned)) {
    rotation.identity();
    for (const [axis, deg] of turns) {
      const about = new THREE.Vector3(...AXES[axis]);
      rotation.multiply(more.setFromAxisAngle(about, (deg * Math.PI) / 180));
    }
    const { w, x, y, z } = rotation;
    values.set([w, x, y, z], 3 + 4 * JOINTS.joints.indexOf(joint));
  }
  const half = (turnDeg * Math.PI) / 360;
  const [w = 1, x = 0, y = 0, z = 0] = values.subarray(3, 7);
  const whole = new THREE.Quaternion(0, Math.sin(half), 0, Math.cos(half));
  whole.multiply(new THREE.Quaternion(x, y, z, w));
  values.set([whole.w, whole.x, whole.y, whole.z], 3);
  movedM?.forEach((by, axis) => {
    values[axis] = (values[axis] ?? 0) + by;
  });
  return values;
}

const headTurns = ({ pitch, yaw }: { readonly pitch: number; readonly yaw: number }) =>
  [
    ["y", yaw],
    ["x", pitch],
  ] as const;

function shownTask(
  { limb, goal, green, red, numbers }: NonNullable<Moment["task"]>,
  layouts: ReturnType<typeof tasksOf.layoutsOf>,
) {
  const colours = new Map<string, "grey" | "green" | "white" | "red">();
  for (const { key, kind } of layouts.get(limb)?.surfaces ?? []) {
    if (kind === "panel") colours.set(key, green.includes(key) ? "green" : "grey");
    else if (kind === "side") colours.set(key, red.includes(key) ? "red" : "white");
    else colours.set(key, kind === "target" ? "green" : "white");
  }
  return { limb, goal, colours, numbers: new Map(numbers.map((number, at) => [at + 1, number])) };
}

const HELD = [0.924, 0.383, 0, 0] as const;
const CONTROLLERS = ([-1, 1] as const).map((side) => ({
  kind: "controller" as const,
  place: {
    positionM: rotate([1, 0, 0, 0], [0.2 * side, 1.2, -0.42]),
    rotation: HELD,
  },
}));

Object.assign(globalThis, {
  room: {
    open,
    draw: (moment: Moment): Drawn => {
      if (draw === null) throw new Error("Open the room first.");
      return draw(moment);
    },
    close: () => world?.dispose(),
  },
});
