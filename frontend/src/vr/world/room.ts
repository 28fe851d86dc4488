/**
 * The room: floor, walls and ceiling, the mirror's frame, and their reflections, in one mesh that
 * is made once. This module imports three.js.
 *
 * Nothing in it catches the eye but the mirror. Its shading is painted on its corners, since nothing
 * here moves: lighter ahead, darker where surfaces meet.
 */
import {
  BufferGeometry,
  CanvasTexture,
  Color,
  Float32BufferAttribute,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  RepeatWrapping,
  SRGBColorSpace,
} from "three";
import type { Mirror } from "./mirror";

/** Half the room's width, and where its back wall and ceiling are; metres. */
const HALF_WIDTH_M = 2.9;
const BACK_Z_M = 3.1;
const HEIGHT_M = 2.9;
/** Of the mirror's frame. */
const FRAME_M = 0.04;
/** Side of a floor tile. */
const TILE_M = 0.5;

const FLOOR = new Color("#aaa497");
const SIDE_WALL = new Color("#d9d6ce");
const BACK_WALL = new Color("#d3d0c8");
const MIRROR_WALL = new Color("#dfddd6");
const CEILING = new Color("#e9e7e1");
const LAMP = new Color("#ffffff");
const SKIRTING = new Color("#c2beb4");
const FRAME = new Color("#4e4b46");
const SKIRTING_M = 0.08;

type Point = readonly [x: number, y: number, z: number];

/** Without a mirror (for comparisons) the wall has its hole, and nothing is behind it. */
export function makeRoom(
  mirror: Mirror,
  hasDouble: boolean,
): Mesh<BufferGeometry, MeshBasicMaterial> {
  const painted = new Painted();
  paintRoom(painted, mirror.planeZM);
  paintFrame(painted, mirror);
  if (hasDouble) painted.reflect(mirror.planeZM);
  paintMirrorWall(painted, mirror);
  const material = new MeshBasicMaterial({ vertexColors: true, map: tileTexture() });
  const mesh = new Mesh(painted.geometry(), material);
  mesh.matrixAutoUpdate = false;
  return mesh;
}

function paintRoom(painted: Painted, front: number): void {
  const [w, back, top] = [HALF_WIDTH_M, BACK_Z_M, HEIGHT_M];
  const depth = back - front;
  painted.panel([-w, 0, back], [2 * w, 0, 0], [0, 0, -depth], FLOOR, FLOOR_EDGES, true);
  painted.panel([-w, top, front], [2 * w, 0, 0], [0, 0, depth], CEILING, CEILING_EDGES);
  painted.panel([-0.8, top - 0.004, -0.6], [1.6, 0, 0], [0, 0, 1.2], LAMP, {});
  const walls: readonly (readonly [Point, Point, Color])[] = [
    [[-w, 0, back], [0, 0, -depth], SIDE_WALL],
    [[w, 0, front], [0, 0, depth], SIDE_WALL],
    [[w, 0, back], [-2 * w, 0, 0], BACK_WALL],
  ];
  for (const [corner, across, colour] of walls) {
    painted.panel(corner, across, [0, top, 0], colour, WALL_EDGES);
    skirting(painted, corner, across);
  }
}

/**
 * The wall around the hole, which shows what is behind it. It ends under the frame: an edge in one
 * plane with the frame's would shine through between the frame and its reflection, pixel by pixel.
 */
function paintMirrorWall(painted: Painted, { planeZM: z, widthM, heightM }: Mirror): void {
  const half = widthM / 2 + FRAME_M / 2;
  const top = heightM + FRAME_M / 2;
  const aside = HALF_WIDTH_M - half;
  const { low, high, left } = WALL_EDGES;
  const up: Point = [0, HEIGHT_M, 0];
  painted.panel([-HALF_WIDTH_M, 0, z], [aside, 0, 0], up, MIRROR_WALL, { low, high, left });
  painted.panel([half, 0, z], [aside, 0, 0], up, MIRROR_WALL, { low, high, right: left });
  painted.panel([-half, top, z], [2 * half, 0, 0], [0, HEIGHT_M - top, 0], MIRROR_WALL, { high });
  const board = aside - FRAME_M / 2;
  skirting(painted, [-HALF_WIDTH_M, 0, z], [board, 0, 0]);
  skirting(painted, [half + FRAME_M / 2, 0, z], [board, 0, 0]);
}

/** A thin frame, which stands a little in front of the glass and so has a reflection, too. */
function paintFrame(painted: Painted, { planeZM: z, widthM, heightM }: Mirror): void {
  const half = widthM / 2;
  const outer = half + FRAME_M;
  painted.bar([-outer, 0, z], [-half, heightM, z + FRAME_DEPTH_M], FRAME);
  painted.bar([half, 0, z], [outer, heightM, z + FRAME_DEPTH_M], FRAME);
  painted.bar([-outer, heightM, z], [outer, heightM + FRAME_M, z + FRAME_DEPTH_M], FRAME);
}
const FRAME_DEPTH_M = 0.02;

/** A board along the lower edge of a wall, drawn just in front of it. */
function skirting(painted: Painted, [x, , z]: Point, across: Point): void {
  const length = Math.hypot(...across);
  // Up x across points out of the wall.
  const [nx, nz] = [-across[2] / length, across[0] / length];
  const corner: Point = [x + 0.006 * nx, 0, z + 0.006 * nz];
  painted.panel(corner, across, [0, SKIRTING_M, 0], SKIRTING, {});
}

/** How much darker a surface is at its edges, as a share. */
interface Edges {
  readonly left?: number;
  readonly right?: number;
  readonly low?: number;
  readonly high?: number;
}
const WALL_EDGES = { left: 0.1, right: 0.1, low: 0.12, high: 0.07 } as const;
const CEILING_EDGES: Edges = { left: 0.08, right: 0.08, high: 0.08, low: 0.04 };
/** Not towards the mirror, below whose glass the floor goes on. */
const FLOOR_EDGES: Edges = { left: 0.16, right: 0.16, low: 0.16 };

/** Coloured quads, seen from where their corners run anticlockwise. */
class Painted {
  readonly #positions: number[] = [];
  readonly #colours: number[] = [];
  readonly #uvs: number[] = [];
  readonly #indices: number[] = [];

  /** A surface from a corner, across to the right and up, as seen from its front. */
  panel(
    corner: Point,
    across: Point,
    up: Point,
    colour: Color,
    edges: Edges,
    isTiled = false,
  ): void {
    const first = this.#positions.length / 3;
    const isPlain = Object.keys(edges).length === 0;
    const steps = isPlain ? [0, 1] : STEPS;
    const [width, height] = [Math.hypot(...across), Math.hypot(...up)];
    for (const v of steps) {
      for (const u of steps) {
        const [x, y, z] = [0, 1, 2].map(
          (axis) => (corner[axis] ?? 0) + u * (across[axis] ?? 0) + v * (up[axis] ?? 0),
        ) as [number, number, number];
        const share =
          darkened(edges.left, u * width) *
          darkened(edges.right, (1 - u) * width) *
          darkened(edges.low, v * height) *
          darkened(edges.high, (1 - v) * height);
        this.#positions.push(x, y, z);
        this.#colours.push(colour.r * share, colour.g * share, colour.b * share);
        // The middle of a tile is plain.
        this.#uvs.push(isTiled ? x / TILE_M + 0.5 : 0.5, isTiled ? z / TILE_M + 0.5 : 0.5);
      }
    }
    const row = steps.length;
    for (let v = 0; v + 1 < row; v++) {
      for (let u = 0; u + 1 < row; u++) {
        const at = first + v * row + u;
        this.#indices.push(at, at + 1, at + row + 1, at, at + row + 1, at + row);
      }
    }
  }

  /** A bar on the wall, from its lower left corner at the wall to the opposite one in the room. */
  bar([x0, y0, z0]: Point, [x1, y1, z1]: Point, colour: Color): void {
    const [w, h, d] = [x1 - x0, y1 - y0, z1 - z0];
    this.panel([x0, y0, z1], [w, 0, 0], [0, h, 0], colour, {});
    const side = colour.clone().multiplyScalar(0.7);
    this.panel([x0, y0, z0], [0, 0, d], [0, h, 0], side, {});
    this.panel([x1, y0, z1], [0, 0, -d], [0, h, 0], side, {});
    this.panel([x0, y1, z1], [w, 0, 0], [0, 0, -d], side, {});
    this.panel([x0, y0, z0], [w, 0, 0], [0, 0, d], side, {});
  }

  /** Everything once more, reflected; its corners in the reversed order. */
  reflect(planeZM: number): void {
    const count = this.#positions.length / 3;
    for (let at = 0; at < count; at++) {
      const [x = 0, y = 0, z = 0] = this.#positions.slice(3 * at, 3 * at + 3);
      this.#positions.push(x, y, 2 * planeZM - z);
    }
    this.#colours.push(...this.#colours);
    this.#uvs.push(...this.#uvs);
    for (let at = this.#indices.length - 1; at >= 0; at--) {
      this.#indices.push((this.#indices[at] ?? 0) + count);
    }
  }

  geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(this.#positions, 3));
    geometry.setAttribute("color", new Float32BufferAttribute(this.#colours, 3));
    geometry.setAttribute("uv", new Float32BufferAttribute(this.#uvs, 2));
    geometry.setIndex(this.#indices);
    return geometry;
  }
}

/** Close to each other near the edges, where a surface becomes darker. */
const STEPS = [0, 0.03, 0.08, 0.15, 0.25, 0.5, 0.75, 0.85, 0.92, 0.97, 1] as const;

/** The light at a distance from an edge, which is darker by a share. */
function darkened(by: number | undefined, metres: number): number {
  if (by === undefined) return 1;
  const near = Math.max(0, 1 - metres / 0.8);
  return 1 - by * near * near;
}

/** A tile with a fine joint: it shows where the floor is, and how the wearer moves over it. */
function tileTexture(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = 256;
  canvas.height = 256;
  const ink = canvas.getContext("2d");
  if (ink !== null) {
    ink.fillStyle = "#ffffff";
    ink.fillRect(0, 0, 256, 256);
    ink.strokeStyle = "#cfccc6";
    ink.lineWidth = 4;
    ink.strokeRect(0, 0, 256, 256);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = RepeatWrapping;
  texture.wrapT = RepeatWrapping;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.anisotropy = 8;
  return texture;
}
