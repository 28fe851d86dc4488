/**
 * The study's road: carriageway with its markings, kerbs, pavements, what stands behind them, and
 * the cars and walkers that are there. This module imports three.js.
 *
 * It is drawn in the room's own axes: x along the road, the way across leads towards -z, and the
 * carriageway is at the height 0 of its group, which sinks under the participant (`road/ground.ts`).
 */
import {
  BoxGeometry,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  DynamicDrawUsage,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Object3D,
  SphereGeometry,
} from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { Actor, Others } from "../road";
import type { Road } from "../telemetry";

/** The most cars, and walkers, that are drawn at once. */
const MOST = 64;
/** Others are led on by their speeds for so long at most, s; then they stand until news come. */
const LONGEST_LEAD_S = 0.5;
/** How far the legs of a walker swing, rad, and the length of a stride with both legs, m. */
const SWING_RAD = 0.45;
const STRIDE_M = 1.35;
const HIPS_M = 0.9;
/** Trunk and head come before the legs. */
const FIRST_LEG = 2;

const ASPHALT = new Color("#53565a");
const PAVEMENT = new Color("#a8a49b");
const KERB = new Color("#c9c6bf");
const PAINT = new Color("#e8e7e2");
const GRASS = new Color("#7d8b66");
const CAR_COLOURS = ["#7f2f2f", "#2f4a7f", "#c9cbce", "#3c3f44", "#6b7f5a", "#b58a3c"] as const;
/** Side of the start square, m. */
const SQUARE_M = 0.6;
const CLOTHES = ["#3f5f7a", "#7a4a3f", "#4f6b4a", "#6a5878"] as const;

/** What the road shows in one frame. */
export interface StreetShown {
  /** How far the street has sunk under the participant, m. */
  readonly sunkM: number;
  readonly others: Others;
  /** The phase's active time now, s: others are led on to it. */
  readonly activeS: number;
  readonly showsStart: boolean;
}

export class Street {
  readonly group = new Group();
  readonly #middleZM: number;
  readonly #kerbM: number;
  readonly #laneM: number;
  readonly #ground: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly #start: Mesh<BufferGeometry, MeshBasicMaterial>;
  /** What has the car's own colour, and what is the same on all. */
  readonly #cars: readonly InstancedMesh[];
  readonly #walkers: readonly InstancedMesh[];
  readonly #strides = new Map<string, { x: number; z: number; walkedM: number }>();
  readonly #at = new Object3D();

  /** `startColour`: of the start square. */
  constructor(
    { road, kerb_height_m: kerbM, starts_behind_kerb_m: behindM }: Road,
    startColour: string,
  ) {
    this.#kerbM = kerbM;
    this.#laneM = road.lane_width_m;
    this.#middleZM = -behindM - road.lane_width_m;
    this.#ground = new Mesh(
      groundOf(road, kerbM, this.#middleZM),
      new MeshBasicMaterial({ vertexColors: true }),
    );
    const half = SQUARE_M / 2;
    const square = [[-half, kerbM + 0.004, half] as const, [SQUARE_M, 0, 0] as const] as const;
    this.#start = new Mesh(
      quad(...square, [0, 0, -SQUARE_M], new Color(startColour)),
      new MeshBasicMaterial({ vertexColors: true }),
    );
    this.#cars = carGeometries().map(instanced);
    this.#walkers = walkerGeometries().map(instanced);
    this.group.add(this.#ground, this.#start, ...this.#cars, ...this.#walkers);
    this.group.visible = false;
  }

  show(shown: StreetShown | null): void {
    this.group.visible = shown !== null;
    if (shown === null) return;
    this.group.position.y = -shown.sunkM;
    this.#start.visible = shown.showsStart;
    const { others, activeS } = shown;
    const leadS = Math.min(LONGEST_LEAD_S, Math.max(0, activeS - others.activeS));
    let [cars, walkers] = [0, 0];
    for (const actor of others.actors) {
      const place = this.#placeOf(actor, leadS);
      if (actor.kind === "car" && cars < MOST) this.#setCar(cars++, actor, place);
      else if (actor.kind === "person" && walkers < MOST) this.#setWalker(walkers++, actor, place);
    }
    for (const [mesh, count] of [
      ...this.#cars.map((one) => [one, cars] as const),
      ...this.#walkers.map((one) => [one, walkers] as const),
    ] as const) {
      mesh.count = count;
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor !== null) mesh.instanceColor.needsUpdate = true;
    }
  }

  dispose(): void {
    for (const { geometry, material } of [this.#ground, this.#start]) {
      geometry.dispose();
      material.dispose();
    }
    for (const mesh of [...this.#cars, ...this.#walkers]) {
      mesh.geometry.dispose();
      (mesh.material as MeshLambertMaterial).dispose();
      mesh.dispose();
    }
  }

  /** Where an actor is in the room after a lead at its speed and turn rate. */
  #placeOf(actor: Actor, leadS: number): { x: number; z: number; headingRad: number } {
    const headingRad = actor.heading_rad + actor.turn_rad_s * leadS;
    const mean = actor.heading_rad + (actor.turn_rad_s * leadS) / 2;
    const x = actor.x_m + actor.speed_m_s * leadS * Math.cos(mean);
    const y = actor.y_m + actor.speed_m_s * leadS * Math.sin(mean);
    return { x, z: this.#middleZM - y, headingRad };
  }

  #setCar(at: number, actor: Actor, { x, z, headingRad }: Placed): void {
    const one = this.#at;
    one.position.set(x, 0, z);
    one.rotation.set(0, headingRad, 0);
    one.scale.set(actor.length_m, 1, actor.width_m);
    one.updateMatrix();
    for (const mesh of this.#cars) mesh.setMatrixAt(at, one.matrix);
    this.#cars[0]?.setColorAt(at, colourOf(actor.name, CAR_COLOURS));
  }

  #setWalker(at: number, { name, width_m: widthM }: Actor, { x, z, headingRad }: Placed): void {
    const stride = this.#strides.get(name) ?? { x, z, walkedM: 0 };
    stride.walkedM += Math.min(0.5, Math.hypot(x - stride.x, z - stride.z));
    [stride.x, stride.z] = [x, z];
    this.#strides.set(name, stride);
    const isOnRoad = Math.abs(z - this.#middleZM) < this.#laneM;
    const floorM = isOnRoad ? 0 : this.#kerbM;
    const swing = SWING_RAD * Math.sin((2 * Math.PI * stride.walkedM) / STRIDE_M);
    const colour = colourOf(name, CLOTHES);
    this.#walkers.forEach((mesh, part) => {
      const one = this.#at;
      const leg = part - FIRST_LEG;
      one.position.set(x, floorM + (leg < 0 ? 0 : HIPS_M), z);
      one.rotation.set(0, headingRad, 0);
      one.scale.set(1, 1, widthM / 0.5);
      if (leg >= 0) one.rotateZ(leg === 0 ? swing : -swing);
      one.updateMatrix();
      mesh.setMatrixAt(at, one.matrix);
      if (part === 0) mesh.setColorAt(at, colour);
    });
  }
}

type Placed = { readonly x: number; readonly z: number; readonly headingRad: number };

function instanced(geometry: BufferGeometry): InstancedMesh {
  const mesh = new InstancedMesh(geometry, new MeshLambertMaterial({ vertexColors: true }), MOST);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  mesh.count = 0;
  return mesh;
}

const COLOURS = new Map<string, Color>();

/** The same colour for the same name. */
function colourOf(name: string, from: readonly string[]): Color {
  let hash = 7;
  for (const letter of name) hash = (hash * 31 + letter.charCodeAt(0)) % 9973;
  const text = from[hash % from.length] ?? "#888888";
  const known = COLOURS.get(text) ?? new Color(text);
  COLOURS.set(text, known);
  return known;
}

/** A geometry in one colour; white takes the instance's own. */
function painted(geometry: BufferGeometry, colour: string): BufferGeometry {
  const { r, g, b } = new Color(colour);
  const count = geometry.getAttribute("position").count;
  const values = Array.from({ length: count }, () => [r, g, b]).flat();
  geometry.setAttribute("color", new Float32BufferAttribute(values, 3));
  return geometry;
}

function box(
  [lengthM, heightM, widthM]: readonly [number, number, number],
  at: readonly [number, number, number],
  colour: string,
): BufferGeometry {
  return painted(new BoxGeometry(lengthM, heightM, widthM).translate(...at), colour);
}

/** A car of 1 x 1 in length and width, its front towards +x: bodywork, and all else. */
function carGeometries(): readonly BufferGeometry[] {
  const wheel = (x: number, z: number) =>
    painted(
      new CylinderGeometry(0.32, 0.32, 0.12, 14)
        .rotateX(Math.PI / 2)
        .scale(1 / 4.5, 1, 1)
        .translate(x, 0.32, z),
      "#18191b",
    );
  const bodywork = [
    box([1, 0.55, 0.98], [0, 0.57, 0], "#ffffff"),
    box([0.44, 0.06, 0.86], [-0.05, 1.42, 0], "#ffffff"),
  ];
  const others = [
    box([0.5, 0.55, 0.86], [-0.05, 1.12, 0], "#2a3138"),
    box([0.006, 0.12, 0.18], [0.5, 0.68, 0.36], "#fff7d6"),
    box([0.006, 0.12, 0.18], [0.5, 0.68, -0.36], "#fff7d6"),
    box([0.006, 0.12, 0.18], [-0.5, 0.7, 0.36], "#b3261e"),
    box([0.006, 0.12, 0.18], [-0.5, 0.7, -0.36], "#b3261e"),
    ...[0.31, -0.31].flatMap((x) => [wheel(x, 0.46), wheel(x, -0.46)]),
  ];
  return [merged(bodywork), merged(others)];
}

/** Trunk with arms, the head, and the two legs, which hang from their hips. */
function walkerGeometries(): readonly BufferGeometry[] {
  const skin = "#c9a68a";
  const trunk = merged([
    painted(new CapsuleGeometry(0.17, 0.38, 4, 12).translate(0, 1.2, 0), "#ffffff"),
    painted(new CapsuleGeometry(0.05, 0.5, 3, 8).translate(0, 1.13, 0.23), "#ffffff"),
    painted(new CapsuleGeometry(0.05, 0.5, 3, 8).translate(0, 1.13, -0.23), "#ffffff"),
  ]);
  const leg = (z: number) =>
    merged([
      painted(new CapsuleGeometry(0.075, 0.7, 3, 8).translate(0, -0.45, z), "#33363b"),
      box([0.25, 0.08, 0.1], [0.06, -0.86, z], "#1d1e20"),
    ]);
  const head = merged([
    painted(new SphereGeometry(0.115, 16, 12).translate(0, 1.62, 0), skin),
    painted(
      new SphereGeometry(0.12, 16, 8, 0, 2 * Math.PI, 0, 1.3).translate(-0.01, 1.63, 0),
      "#3b2c22",
    ),
  ]);
  return [trunk, head, leg(0.09), leg(-0.09)];
}

function merged(parts: BufferGeometry[]): BufferGeometry {
  const geometry = mergeGeometries(parts.map((one) => one.toNonIndexed()));
  for (const part of parts) part.dispose();
  if (geometry === null) throw new Error("These parts cannot be merged.");
  return geometry;
}

/** Carriageway, markings, kerbs, pavements and the grass behind them, in one mesh. */
function groundOf(road: Road["road"], kerbM: number, middleZM: number): BufferGeometry {
  const { half_length_m: end, lane_width_m: lane, pavement_width_m: pavement } = road;
  const quads: BufferGeometry[] = [];
  /** A level rectangle; y across the road, as in scenes. */
  const level = (x: readonly [number, number], y: readonly [number, number], h: number, c: Color) =>
    quads.push(quad([x[0], h, middleZM - y[0]], [x[1] - x[0], 0, 0], [0, 0, y[0] - y[1]], c));
  level([-end, end], [-lane, lane], 0, ASPHALT);
  for (const side of [-1, 1] as const) {
    const [inner, outer] = [side * lane, side * (lane + pavement)];
    const between = (a: number, b: number): readonly [number, number] => [
      Math.min(a, b),
      Math.max(a, b),
    ];
    level([-end, end], between(inner, inner + side * 0.15), kerbM, KERB);
    level([-end, end], between(inner + side * 0.15, outer), kerbM, PAVEMENT);
    level([-end, end], between(outer, outer + side * 60), kerbM, GRASS);
    // The kerb's face towards the carriageway.
    const [from, across]: [number, number] = side < 0 ? [end, -2 * end] : [-end, 2 * end];
    quads.push(
      quad(
        [from, 0, middleZM - inner],
        [across, 0, 0],
        [0, kerbM, 0],
        KERB.clone().multiplyScalar(0.75),
      ),
    );
  }
  const crossing = road.crossing_width_m;
  const keepsFree = crossing === null ? 0 : crossing / 2 + 1;
  for (let x = -end; x + 3 <= end; x += 9) {
    if (x + 3 > -keepsFree && x < keepsFree) continue;
    level([x, x + 3], [-0.06, 0.06], 0.004, PAINT);
  }
  if (crossing !== null) {
    for (let y = -lane + 0.25; y + 0.5 <= lane; y += 1) {
      level([-crossing / 2, crossing / 2], [y, y + 0.5], 0.004, PAINT);
    }
  }
  return merged(quads);
}

type Point = readonly [x: number, y: number, z: number];

/** A quad from a corner, across to the right and up, seen from its front. */
function quad([x, y, z]: Point, across: Point, up: Point, { r, g, b }: Color): BufferGeometry {
  const at = (u: number, v: number) => [
    x + u * across[0] + v * up[0],
    y + u * across[1] + v * up[1],
    z + u * across[2] + v * up[2],
  ];
  const corners = [at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)];
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(corners.flat(), 3));
  const colours = corners.flatMap(() => [r, g, b]);
  geometry.setAttribute("color", new Float32BufferAttribute(colours, 3));
  return geometry;
}
