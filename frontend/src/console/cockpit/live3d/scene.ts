/**
 * The live scene: the newest poses among the boxes of the task. This module imports three.js:
 * import it lazily.
 */
import type { PoseSetup, PoseStream } from "@shared/api/poses";
import type { BodyRoles, Figure, StagePalette } from "@shared/stage/figure";
import { withFingers, writeFingers } from "@shared/stage/fingers";
import { type BodyMarks, NO_MARKS } from "@shared/stage/marks";
import { BodyMarks3d } from "@shared/stage/marks3d";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { type LivePose, livePose, numbersOf } from "@shared/stage/skin/pose";
import { bodyOf, Space3d, type StageBody } from "@shared/stage/space3d";
import { seconds } from "@shared/units";
import { PerspectiveCamera } from "three";
import { heatColour } from "./heat";
import { makePlaced, type Placed, place, restValues } from "./kinematics";
import { aim, type View } from "./views";

const STREAMS: readonly PoseStream[] = ["actual", "target"];
const NOW = seconds(0);
/** The floor of the study, metres: it is the same for everybody. */
const FLOOR = { min: [-2, -3], max: [2, 1], step: 1 } as const;

interface Player {
  readonly body: StageBody;
  readonly pose: LivePose;
  readonly placed: Placed;
  received: boolean;
}

export class LiveScene extends Space3d {
  /** Called after every picture. */
  onDrawn = (): void => {};
  #players: ReadonlyMap<PoseStream, Player> = new Map();
  #setup: PoseSetup | null = null;
  #view: View = "third";
  #marks: BodyMarks3d | null = null;
  #marked: BodyMarks = NO_MARKS;
  #covered = 0;

  /** Throws if the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement) {
    super(new PerspectiveCamera(45, 1, 0.08, 60), { canvas, alpha: true });
  }

  /**
   * Rebuild bodies and boxes; poses already shown stay where they are. Without a model the figures
   * are skeletons.
   */
  prepare(setup: PoseSetup, palette: StagePalette, model: BodyModel | null): void {
    this.#setup = setup;
    this.#players = new Map(
      STREAMS.filter((stream) => !(setup.blinded && stream === "actual")).map((stream) => [
        stream,
        makePlayer(setup, stream, { palette, model }, this.#players.get(stream)),
      ]),
    );
    this.standBodies([...this.#players.values()].map(({ body }) => body));
    this.#standMarks(setup);
    const blocks = setup.surfaces.map(({ key, kind, center_m, half_size_m }) => ({
      key,
      wall: kind === "side",
      center: center_m,
      halfSize: half_size_m,
    }));
    this.standBlocks(blocks, palette);
    this.layFloor({ ...FLOOR, box: { min: [-2, 0, -3], max: [2, 2, 1] } }, palette);
    this.#moved();
  }

  show(stream: PoseStream, values: Float32Array): void {
    const player = this.#players.get(stream);
    // Request a picture all the same: the server waits for the acknowledgement that the pose was
    // drawn.
    if (player === undefined || this.#setup === null) {
      this.requestPicture();
      return;
    }
    player.received = true;
    place(this.#setup, values, player.placed);
    player.pose.values.set(values);
    player.body.show(NOW);
    if (stream === "actual") this.#marks?.show(player.placed.positions);
    this.#moved();
  }

  /** Bend the fingers of a body; the next pose of the body shows them. */
  bend(stream: PoseStream, rotations: Float32Array): void {
    const player = this.#players.get(stream);
    if (player === undefined || this.#setup === null) return;
    writeFingers(rotations, 0, player.pose.values, numbersOf(this.#setup.joints));
  }

  /** Mark the parts of the avatar that are in a cast or have no collider. */
  mark(marks: BodyMarks): void {
    this.#marked = marks;
    if (this.#marks !== null) this.#marks.marks = marks;
    const avatar = this.#players.get("actual");
    if (avatar?.received) this.#marks?.show(avatar.placed.positions);
    this.requestPicture();
  }

  override dispose(): void {
    this.#marks?.dispose();
    super.dispose();
  }

  /** A blinded reader does not see the avatar, and so no marks. */
  #standMarks(setup: PoseSetup): void {
    if (this.#marks !== null) {
      this.scene.remove(this.#marks.group);
      this.#marks.dispose();
    }
    this.#marks = setup.blinded ? null : new BodyMarks3d(setup.joints, setup.parents);
    if (this.#marks !== null) this.scene.add(this.#marks.group);
    this.mark(this.#marked);
  }

  /** Colour the avatar by its joint errors, degrees. */
  heat(errors: Readonly<Record<string, number | null>>): void {
    const { body } = this.#players.get("actual") ?? {};
    const joints = this.#setup?.joints;
    if (body === undefined || joints === undefined) return;
    body.paint((point) => heatColour(errors[joints[point] ?? ""]));
    this.requestPicture();
  }

  setView(view: View): void {
    this.#view = view;
    this.#moved();
  }

  /** Draw the scene in the middle of what is left below the upper `height` pixels. */
  cover(height: number): void {
    this.#covered = height;
    this.#moved();
  }

  protected override resized(): void {
    this.#moved();
  }

  protected override drawn(): void {
    this.onDrawn();
  }

  /** Called after a figure has moved: the camera follows. */
  #moved(): void {
    const came = STREAMS.filter((stream) => this.#players.get(stream)?.received);
    for (const [stream, { body, received: is }] of this.#players) {
      // In the first-person view the participant's own figure would block the view.
      body.group.visible = is && !(this.#view === "first" && stream === "target");
      const isInside = this.#view === "first";
      if (body.headless === isInside) continue;
      body.headless = isInside;
      body.show(NOW);
    }
    // The display shows what the participant's head sees, whatever the avatar does.
    const eyes = this.#players.get(came.includes("target") ? "target" : "actual");
    const followed = this.#players.get(came[0] ?? "actual") ?? eyes;
    aim(this.camera, this.#view, {
      setup: this.#setup,
      eyes: eyes?.received ? eyes.placed : null,
      followed: followed?.received ? followed.placed : null,
    });
    this.#uncover();
    this.requestPicture();
  }

  /** Shift the picture down by half of what is covered; the wearer's hands are low already. */
  #uncover(): void {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const isFree = this.#view === "first" || this.#covered >= height;
    if (width === 0 || isFree) this.camera.clearViewOffset();
    else this.camera.setViewOffset(width, height, 0, -this.#covered / 2, width, height);
  }
}

/** Fingers about which nothing is known: they are straight. */
const NO_FINGERS: readonly number[] = [];

function makePlayer(
  setup: PoseSetup,
  stream: PoseStream,
  { palette, model }: { readonly palette: StagePalette; readonly model: BodyModel | null },
  previous: Player | undefined,
): Player {
  const placed = makePlaced(setup.joints.length);
  const rest = restValues(setup);
  place(setup, rest, placed);
  const { joints, parents } = withFingers(setup.joints, setup.parents);
  const pose = livePose(joints, parents);
  pose.values.set(rest);
  writeFingers(NO_FINGERS, 0, pose.values, numbersOf(setup.joints));
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
    ...(model === null ? {} : { worn: { model, statureM: setup.stature_m, pose } }),
  };
  // Measured in the rest pose, then put back to where it was.
  const body = bodyOf(figure, palette);
  if (previous !== undefined && previous.placed.positions.length === placed.positions.length) {
    placed.positions.set(previous.placed.positions);
    placed.rotations.set(previous.placed.rotations);
    pose.values.set(previous.pose.values);
  }
  body.show(NOW);
  return { body, pose, placed, received: previous?.received ?? false };
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
