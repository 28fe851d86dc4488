/**
 * Marks around parts of a body whose settings were changed: a sleeve around parts in a cast, and
 * an open net around parts without a collider. They are drawn around any figure, with or without
 * skin.
 */
import {
  CylinderGeometry,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { type BodyMarks, MARK_COLOURS, NO_MARKS } from "./marks";

const UP = new Vector3(0, 1, 0);
const NOWHERE = new Matrix4().makeScale(0, 0, 0);
/** Metres: wider than an arm with its skin, narrower than the gap between arm and trunk. */
const RADIUS = { cast: 0.062, passing: 0.072 } as const;
/** A net is drawn through the body, so that its back can be seen as well. */
const END_RADIUS = 0.075;

export class BodyMarks3d {
  readonly group = new Group();
  readonly #names: readonly string[];
  readonly #parents: readonly number[];
  readonly #cast: Sleeves;
  readonly #passing: Sleeves;
  #marks: BodyMarks = NO_MARKS;

  constructor(names: readonly string[], parents: readonly number[]) {
    this.#names = names;
    this.#parents = parents;
    const plaster = new MeshLambertMaterial({
      color: MARK_COLOURS.cast,
      transparent: true,
      opacity: 0.85,
    });
    const net = new MeshBasicMaterial({
      color: MARK_COLOURS.passing,
      wireframe: true,
      transparent: true,
      opacity: 0.8,
      depthTest: false,
    });
    this.#cast = sleeves(names.length, plaster);
    this.#passing = sleeves(names.length, net);
    for (const mesh of [...Object.values(this.#cast), ...Object.values(this.#passing)]) {
      this.group.add(mesh);
    }
    this.group.renderOrder = 1;
  }

  set marks(marks: BodyMarks) {
    this.#marks = marks;
    this.group.visible = marks.cast.length + marks.passing.length > 0;
  }

  /** Follow the joints, whose positions are given one after the other, metres. */
  show(positions: ArrayLike<number>): void {
    if (!this.group.visible) return;
    this.#place(this.#cast, this.#marks.cast, RADIUS.cast, positions);
    this.#place(this.#passing, this.#marks.passing, RADIUS.passing, positions);
  }

  dispose(): void {
    for (const mesh of [...Object.values(this.#cast), ...Object.values(this.#passing)]) {
      mesh.geometry.dispose();
      mesh.material.dispose();
      mesh.dispose();
    }
  }

  /** A part reaches from its joint to those below it; a hand, foot or head is a ball. */
  #place(
    { tubes, balls }: Sleeves,
    marked: readonly string[],
    radius: number,
    positions: ArrayLike<number>,
  ): void {
    const at = (point: number) => new Vector3().fromArray(positions, 3 * point);
    const isMarked = new Set(marked);
    const ends = new Set(this.#parents);
    const matrix = new Matrix4();
    const turned = new Quaternion();
    this.#names.forEach((name, point) => {
      const parent = this.#parents[point] ?? -1;
      const isSleeve = parent >= 0 && isMarked.has(this.#names[parent] ?? "");
      tubes.setMatrixAt(point, NOWHERE);
      if (isSleeve) {
        const from = at(parent);
        const along = at(point).sub(from);
        const length = along.length();
        turned.setFromUnitVectors(UP, length > 0 ? along.clone().divideScalar(length) : UP);
        const middle = from.addScaledVector(along, 0.5);
        matrix.compose(middle, turned, new Vector3(radius, length, radius));
        if (Number.isFinite(length)) tubes.setMatrixAt(point, matrix);
      }
      const isEnd = !ends.has(point) && isMarked.has(name);
      const place = at(point);
      matrix.makeScale(END_RADIUS, END_RADIUS, END_RADIUS).setPosition(place);
      balls.setMatrixAt(point, isEnd && Number.isFinite(place.x) ? matrix : NOWHERE);
    });
    tubes.instanceMatrix.needsUpdate = true;
    balls.instanceMatrix.needsUpdate = true;
  }
}

type Material = MeshLambertMaterial | MeshBasicMaterial;

interface Sleeves {
  readonly tubes: InstancedMesh<CylinderGeometry, Material>;
  readonly balls: InstancedMesh<SphereGeometry, Material>;
}

function sleeves(count: number, material: Material): Sleeves {
  const tubes = new InstancedMesh(new CylinderGeometry(1, 1, 1, 12, 3, true), material, count);
  const balls = new InstancedMesh(new SphereGeometry(1, 12, 8), material, count);
  for (const mesh of [tubes, balls]) {
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
  }
  return { tubes, balls };
}
