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
const FRAME_M = 0.035;
/** Side of a floor tile. */
const TILE_M = 0.5;

const FLOOR = new Color("#b9b4aa");
const WALL = new Color("#dcdad4");
const MIRROR_WALL = new Color("#d2d3cf");
const CEILING = new Color("#ecebe7");
const SKIRTING = new Color("#c3c0b9");
const FRAME = new Color("#5c5a55");

type Point = readonly [x: number, y: number, z: number];

/** Without a mirror (for comparisons) the wall has its hole, and nothing is behind it. */
export function makeRoom(
  mirror: Mirror,
  hasDouble: boolean,
): Mesh<BufferGeometry, MeshBasicMaterial> {
  const quads = new Quads();
  drawRoom(quads, mirror.planeZM);
  if (hasDouble) quads.reflect(mirror.planeZM);
  drawMirrorWall(quads, mirror);
  const material = new MeshBasicMaterial({ vertexColors: true, map: tileTexture() });
  const mesh = new Mesh(quads.geometry(), material);
  mesh.matrixAutoUpdate = false;
  return mesh;
}

function drawRoom(quads: Quads, front: number): void {
  const [w, back, top] = [HALF_WIDTH_M, BACK_Z_M, HEIGHT_M];
  quads.floor([-w, 0, back], [w, 0, front], FLOOR);
  const corner = 0.82;
  // Anticlockwise as seen from inside, from the lower left corner.
  const walls: readonly (readonly [Point, Point])[] = [
    [
      [-w, 0, back],
      [-w, 0, front],
    ],
    [
      [w, 0, front],
      [w, 0, back],
    ],
    [
      [w, 0, back],
      [-w, 0, back],
    ],
  ];
  for (const [left, right] of walls) {
    quads.wall(left, right, 0.09, top, WALL, corner);
    quads.wall(left, right, 0, 0.09, SKIRTING, 1);
  }
  quads.quad(
    [
      [-w, top, front],
      [w, top, front],
      [w, top, back],
      [-w, top, back],
    ],
    CEILING,
  );
}

/** The wall around the hole, which shows what is behind it, and a thin frame. */
function drawMirrorWall(quads: Quads, { planeZM: z, widthM, heightM }: Mirror): void {
  const half = widthM / 2;
  const w = HALF_WIDTH_M;
  quads.wall([-w, 0, z], [-half, 0, z], 0, HEIGHT_M, MIRROR_WALL, 0.93);
  quads.wall([half, 0, z], [w, 0, z], 0, HEIGHT_M, MIRROR_WALL, 0.93);
  quads.wall([-half, 0, z], [half, 0, z], heightM, HEIGHT_M, MIRROR_WALL, 1);
  const near = z + 0.012;
  const outer = half + FRAME_M;
  const bars: readonly (readonly [number, number, number, number])[] = [
    [-outer, -half, 0, heightM + FRAME_M],
    [half, outer, 0, heightM + FRAME_M],
    [-half, half, heightM, heightM + FRAME_M],
  ];
  for (const [x0, x1, y0, y1] of bars) {
    quads.quad(
      [
        [x0, y0, near],
        [x1, y0, near],
        [x1, y1, near],
        [x0, y1, near],
      ],
      FRAME,
    );
  }
}

/** Coloured quads; each is anticlockwise as seen from its front. */
class Quads {
  readonly #positions: number[] = [];
  readonly #colours: number[] = [];
  readonly #uvs: number[] = [];
  readonly #indices: number[] = [];

  /** The whole quad has one colour, or each corner its share of it. */
  quad(corners: readonly [Point, Point, Point, Point], colour: Color, shares?: readonly number[]) {
    const first = this.#positions.length / 3;
    corners.forEach((corner, at) => {
      const share = shares?.[at] ?? 1;
      this.#positions.push(...corner);
      this.#colours.push(colour.r * share, colour.g * share, colour.b * share);
      // The middle of a tile, which is plain.
      this.#uvs.push(0.5, 0.5);
    });
    this.#indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
  }

  /** A wall from its lower left to its lower right corner; darker at its lower edge. */
  wall(left: Point, right: Point, low: number, high: number, colour: Color, below: number): void {
    const at = ([x, , z]: Point, y: number): Point => [x, y, z];
    const rows = [low, low + 0.25 * (high - low), high];
    const shares = [below, (1 + below) / 2 + 0.02, 1];
    for (let row = 0; row + 1 < rows.length; row++) {
      const [y0 = 0, y1 = 0] = rows.slice(row, row + 2);
      const [s0 = 1, s1 = 1] = shares.slice(row, row + 2);
      quadOf(this, at(left, y0), at(right, y0), at(right, y1), at(left, y1), colour, [
        s0,
        s0,
        s1,
        s1,
      ]);
    }
  }

  /** A tiled floor, darker towards the walls. */
  floor([x0, y, back]: Point, [x1, , front]: Point, colour: Color): void {
    const xs = ease(x0, x1);
    const zs = ease(front, back);
    const share = (x: number, z: number) =>
      0.86 + 0.14 * rise(Math.min(x - x0, x1 - x)) * rise(Math.min(z - front, back - z) + 0.3);
    for (let i = 0; i + 1 < xs.length; i++) {
      for (let j = 0; j + 1 < zs.length; j++) {
        const [a = 0, b = 0] = xs.slice(i, i + 2);
        const [c = 0, d = 0] = zs.slice(j, j + 2);
        const corners = [
          [a, y, d],
          [b, y, d],
          [b, y, c],
          [a, y, c],
        ] as const;
        this.quad(
          [...corners],
          colour,
          corners.map(([x, , z]) => share(x, z)),
        );
        const tiles = corners.flatMap(([x, , z]) => [x / TILE_M + 0.5, z / TILE_M + 0.5]);
        this.#uvs.splice(-8, 8, ...tiles);
      }
    }
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

function quadOf(
  quads: Quads,
  a: Point,
  b: Point,
  c: Point,
  d: Point,
  colour: Color,
  shares: readonly number[],
): void {
  quads.quad([a, b, c, d], colour, shares);
}

/** Steps from one wall to the other, close to each other near the walls. */
const ease = (from: number, to: number): readonly number[] =>
  [0, 0.06, 0.15, 0.3, 0.5, 0.7, 0.85, 0.94, 1].map((share) => from + share * (to - from));

/** 0 at a wall, 1 from 0.9 m away on. */
const rise = (metres: number): number => {
  const share = Math.min(1, Math.max(0, metres / 0.9));
  return share * share * (3 - 2 * share);
};

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
