import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { SkinnedMesh, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { describe, expect, it } from "vitest";
import { seconds } from "../../units";
import type { Figure, StagePalette } from "../figure";
import { type BodyModel, PART_ATTRIBUTE } from "./bodyModel";
import { bodyOfGltf } from "./gltfBody";
import { type BodyBinding, livePose, Parts, poseOf, restPose } from "./pose";
import { SkinnedBody3d } from "./skinnedBody3d";

/** The files are made by our own script; the README in their folder describes the format. */
const FOLDER = resolve(import.meta.dirname, "../../../../../tests/vectors/skin");
const vectors: SkinVectors = JSON.parse(readFileSync(resolve(FOLDER, "skin.json"), "utf8"));
const { binding } = vectors;
const ALIKE_M = 1e-5;

interface SkinVectors {
  readonly binding: BodyBinding;
  readonly cases: readonly {
    readonly name: string;
    readonly stature_m: number;
    readonly hips_m: readonly number[];
    readonly rotations: readonly (readonly number[])[];
    readonly vertices: readonly {
      readonly rows: readonly number[];
      readonly places_m: readonly (readonly number[])[];
    }[];
  }[];
}

const PALETTE = { shadow: "#ccc", ghost: "#555" } as StagePalette;

async function body(): Promise<BodyModel> {
  const file = readFileSync(resolve(FOLDER, "body.glb"));
  const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
  return bodyOfGltf(await new GLTFLoader().parseAsync(bytes, ""), binding);
}

/** A figure of all the body's parts that wears it, in the pose that `values` is set to. */
function wearing(model: BodyModel, statureM: number, tone: Figure["tone"] = "solid") {
  const pose = livePose(binding.parts, binding.parents);
  const figure: Figure = {
    key: "body",
    tone,
    motion: {
      kind: "skeleton",
      names: binding.parts,
      parents: binding.parents,
      frames: 1,
      rateHz: 1,
      recordedRateHz: 1,
      positions: new Float32Array(3 * binding.parts.length),
    },
  };
  const drawn = new SkinnedBody3d(figure, { model, statureM, pose }, PALETTE);
  const skins: SkinnedMesh[] = [];
  drawn.group.traverse((object) => {
    if (object instanceof SkinnedMesh && object.matrix.elements[5] === 1) skins.push(object);
  });
  return { drawn, pose, skins };
}

describe("a posed skin", () => {
  it("is where the server computes it, in any stature and pose", async () => {
    const model = await body();
    for (const { stature_m, hips_m, rotations, vertices } of vectors.cases) {
      const { drawn, pose, skins } = wearing(model, stature_m);
      pose.values.set([...hips_m, ...rotations.flat()]);
      drawn.show(seconds(0));
      expect(skins.length).toBe(vertices.length);
      vertices.forEach(({ rows, places_m }, at) => {
        const far = rows.map((row, index) => {
          const drawnAt = (skins[at] as SkinnedMesh).getVertexPosition(row, new Vector3());
          return drawnAt.distanceTo(new Vector3(...(places_m[index] ?? [])));
        });
        expect(Math.max(...far)).toBeLessThan(ALIKE_M);
      });
      drawn.dispose();
    }
  });

  it("stays where it was while a rotation is unknown", async () => {
    const { drawn, pose, skins } = wearing(await body(), 1.7);
    pose.values.set(restPose(binding.parts, [0, 1, 0]));
    drawn.show(seconds(0));
    const [skin] = skins as [SkinnedMesh];
    const before = skin.getVertexPosition(0, new Vector3());
    for (const unknown of [Number.NaN, 0]) {
      pose.values.fill(unknown, 3, 7);
      pose.values[0] = 5;
      drawn.show(seconds(0));
      expect(skin.getVertexPosition(0, new Vector3())).toEqual(before);
    }
  });

  it("is drawn without its head from its own eyes, and without a shadow as a ghost", async () => {
    const model = await body();
    const { drawn, pose, skins } = wearing(model, 1.7, "ghost");
    const [skin] = skins as [SkinnedMesh];
    const partOf = (corner: number) => {
      const { geometry } = skin;
      return binding.parts[
        geometry.getAttribute(PART_ATTRIBUTE).getX(geometry.index?.getX(corner) ?? 0)
      ];
    };
    const shown = () =>
      Array.from({ length: Math.floor((skin.geometry.index?.count ?? 0) / 3) }, (_, triangle) =>
        [0, 1, 2].map((corner) => partOf(3 * triangle + corner)),
      );
    const whole = shown();
    pose.values.set(restPose(binding.parts, [0, 1, 0]));
    drawn.headless = true;
    drawn.show(seconds(0));
    const isHead = (part: string | undefined) => /Head|Eye|Jaw/.test(part ?? "");
    expect(shown()).toEqual(whole.filter((triangle) => !triangle.some(isHead)));
    expect(whole.some((triangle) => triangle.some(isHead))).toBe(true);
    drawn.headless = false;
    drawn.show(seconds(0));
    expect(shown()).toEqual(whole);
    let meshes = 0;
    drawn.group.traverse((object) => {
      if (object instanceof SkinnedMesh) meshes++;
    });
    expect(meshes).toBe(skins.length);
  });
});

describe("the parts of a body", () => {
  it("that the pose does not have move with the part above them", () => {
    const names = ["Hips", "Head"];
    const parts = new Parts(binding, 1, { joints: names, parents: [-1, 0] });
    // A quarter turn to the left: what was at the right, +x, is now in front, -z.
    const half = Math.SQRT1_2;
    const values = Float32Array.from([0, 1, 0, half, 0, half, 0, 1, 0, 0, 0]);
    expect(parts.place(values)).toBe(true);
    const hand = binding.parts.indexOf("RightHand");
    const side = (binding.joints_m[hand]?.[0] ?? 0) - (binding.joints_m[0]?.[0] ?? 0);
    expect(parts.places[3 * hand + 2]).toBeCloseTo(-side, 5);
    expect([...parts.rotations.subarray(4 * hand, 4 * hand + 4)]).toEqual([
      ...parts.rotations.subarray(0, 4),
    ]);
  });

  it("turn by rotations of 16 bits as by those of 32", () => {
    const motion = {
      ...({ kind: "skeleton", names: ["Hips"], parents: [-1], frames: 1, rateHz: 1 } as const),
      recordedRateHz: 1,
      positions: Float32Array.from([1, 2, 3]),
      rotations: Int16Array.from([23170, 0, 23170, 0]),
    };
    const parts = new Parts(binding, 1, { joints: motion.names, parents: motion.parents });
    const values = new Float32Array(7);
    poseOf(motion)?.read(0, values);
    expect(parts.place(values)).toBe(true);
    expect(parts.rotations[0]).toBeCloseTo(Math.SQRT1_2, 6);
    expect(poseOf({ ...motion, rotations: undefined } as never)).toBeNull();
  });
});
