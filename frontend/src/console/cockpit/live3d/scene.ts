/**
 * The live scene: the newest poses among the boxes of the task. Drawn once an animation frame at
 * most, and only after something has changed. This module brings three.js with it: import it lazily.
 */
import type { PoseSetup, PoseStream } from "@shared/api/poses";
import { Blocks3d } from "@shared/stage/blocks3d";
import { Body3d } from "@shared/stage/body3d";
import type { BlockTones, BodyRoles, Figure, StagePalette } from "@shared/stage/figure";
import { disposeFloor, makeFloor } from "@shared/stage/floor3d";
import { seconds } from "@shared/units";
import {
  AmbientLight,
  DirectionalLight,
  type Group,
  PerspectiveCamera,
  Scene,
  WebGLRenderer,
} from "three";
import { heatColour } from "./heat";
import { makePlaced, type Placed, place, restValues } from "./kinematics";
import { aim, type View } from "./views";

const STREAMS: readonly PoseStream[] = ["actual", "target"];
const NOW = seconds(0);
/** The place of the study, metres: it is the same for everybody. */
const FLOOR = { min: [-2, -3], max: [2, 1], step: 1 } as const;

interface Player {
  readonly body: Body3d;
  readonly placed: Placed;
  came: boolean;
}

export class LiveScene {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(45, 1, 0.08, 60);
  #players = new Map<PoseStream, Player>();
  #blocks: Blocks3d | null = null;
  #floor: Group | null = null;
  #setup: PoseSetup | null = null;
  #view: View = "third";
  #asked = 0;

  /** Throws where the browser has no WebGL. `onDrawn` is called after every picture. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly onDrawn: () => void,
  ) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    const sun = new DirectionalLight("#ffffff", 2.1);
    sun.position.set(2, 6, 3);
    this.#scene.add(new AmbientLight("#ffffff", 1.5), sun);
  }

  /** Make bodies and boxes anew; poses that were shown stay where they are. */
  prepare(setup: PoseSetup, palette: StagePalette): void {
    const before = this.#players;
    this.#clear();
    this.#setup = setup;
    for (const stream of STREAMS) {
      if (setup.blinded && stream === "actual") continue;
      const known = before.get(stream);
      const player = makePlayer(setup, stream, palette, known);
      this.#players.set(stream, player);
      this.#scene.add(player.body.group);
    }
    this.#blocks = new Blocks3d(
      setup.surfaces.map(({ key, kind, center_m, half_size_m }) => ({
        key,
        wall: kind === "side",
        center: center_m,
        halfSize: half_size_m,
      })),
      palette,
    );
    const plan = { ...FLOOR, box: { min: [-2, 0, -3], max: [2, 2, 1] } } as const;
    this.#floor = makeFloor(plan, palette);
    this.#scene.add(this.#blocks.group, this.#floor);
    this.#moved();
  }

  show(stream: PoseStream, values: Float32Array): void {
    const player = this.#players.get(stream);
    // Asked for all the same: whoever sent it waits to hear that it was drawn.
    if (player === undefined || this.#setup === null) {
      this.#ask();
      return;
    }
    player.came = true;
    place(this.#setup, values, player.placed);
    player.body.show(NOW);
    this.#moved();
  }

  light(tones: BlockTones): void {
    this.#blocks?.light(tones);
    this.#ask();
  }

  /** Colour the avatar by how far its joints are off, degrees. */
  heat(errors: Readonly<Record<string, number | null>>): void {
    const { body } = this.#players.get("actual") ?? {};
    const joints = this.#setup?.joints;
    if (body === undefined || joints === undefined) return;
    body.paint((point) => heatColour(errors[joints[point] ?? ""]));
    this.#ask();
  }

  look(view: View): void {
    this.#view = view;
    this.#moved();
  }

  resize(width: number, height: number): void {
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#moved();
    // At once: a canvas is empty after its size has changed.
    this.#draw();
  }

  dispose(): void {
    cancelAnimationFrame(this.#asked);
    this.#clear();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss();
  }

  #clear(): void {
    for (const { body } of this.#players.values()) {
      this.#scene.remove(body.group);
      body.dispose();
    }
    this.#players = new Map();
    if (this.#blocks !== null) {
      this.#scene.remove(this.#blocks.group);
      this.#blocks.dispose();
      this.#blocks = null;
    }
    if (this.#floor !== null) {
      this.#scene.remove(this.#floor);
      disposeFloor(this.#floor);
      this.#floor = null;
    }
  }

  /** Something stands elsewhere: the camera goes along. */
  #moved(): void {
    const came = STREAMS.filter((stream) => this.#players.get(stream)?.came);
    for (const [stream, { body, came: is }] of this.#players) {
      // Out of the participant's own eyes, their own figure would be in the way.
      body.group.visible = is && !(this.#view === "first" && stream === "target");
    }
    // The display shows what the participant's head sees, whatever the avatar does.
    const eyes = this.#players.get(came.includes("target") ? "target" : "actual");
    const followed = this.#players.get(came[0] ?? "actual") ?? eyes;
    aim(this.#camera, this.#view, {
      setup: this.#setup,
      eyes: eyes?.came ? eyes.placed : null,
      followed: followed?.came ? followed.placed : null,
    });
    this.#ask();
  }

  #ask(): void {
    if (this.#asked !== 0) return;
    this.#asked = requestAnimationFrame(() => this.#draw());
  }

  #draw(): void {
    cancelAnimationFrame(this.#asked);
    this.#asked = 0;
    this.#renderer.render(this.#scene, this.#camera);
    this.onDrawn();
  }
}

function makePlayer(
  setup: PoseSetup,
  stream: PoseStream,
  palette: StagePalette,
  known: Player | undefined,
): Player {
  const placed = makePlaced(setup.joints.length);
  place(setup, restValues(setup), placed);
  const figure: Figure = {
    key: stream,
    motion: {
      kind: "skeleton",
      names: setup.joints,
      parents: setup.parents,
      frames: 1,
      rateHz: 1,
      recordedRateHz: 1,
      positions: placed.positions,
    },
    tone: stream === "target" && !setup.blinded ? "ghost" : "solid",
    roles: rolesOf(setup.joints),
  };
  // Measured in the rest pose, then put back to where it was.
  const body = new Body3d(figure, palette);
  if (known !== undefined && known.placed.positions.length === placed.positions.length) {
    placed.positions.set(known.placed.positions);
    placed.turns.set(known.placed.turns);
  }
  body.show(NOW);
  return { body, placed, came: known?.came ?? false };
}

/** Which joints of the product's body are which part of it, by their HumanBodyBones names. */
function rolesOf(joints: readonly string[]): BodyRoles {
  const of = (name: string): number | null => {
    const at = joints.indexOf(name);
    return at < 0 ? null : at;
  };
  const side = (name: "Left" | "Right"): ReadonlySet<number> =>
    new Set(joints.flatMap((joint, at) => (joint.startsWith(name) ? [at] : [])));
  return {
    head: of("Head"),
    leftHip: of("LeftUpperLeg"),
    rightHip: of("RightUpperLeg"),
    left: side("Left"),
    right: side("Right"),
  };
}
