/**
 * Which surfaces of a task the avatar touches, in the form that the task's rules use. The server's
 * `app/science/avatar/simulation/touches.py` says what counts as a touch and when it ends.
 */
import type { Contacts } from "./contacts";
import { type ModelTable, parentOf } from "./modelTable";
import type { Boxes } from "./switches";
import type { Views } from "./views";

const BOTH = [0, 1] as const;

export class SurfaceTouches {
  /** By surface and part (S x P, 0 or 1): touches, and what is near enough to keep one. */
  readonly touched: Uint8Array;
  readonly near: Uint8Array;
  private readonly continuing: Uint8Array;
  private readonly surfaceGeoms: readonly number[];
  private readonly marks: readonly number[];
  private readonly surfaceOf: Int32Array;
  /** The reported part that each geom counts as; -1 in the scene. */
  private readonly partOf: Int32Array;

  constructor(
    private readonly views: Views,
    table: ModelTable,
    boxes: Boxes,
    private readonly contacts: Contacts,
    surfaces: readonly string[],
    private readonly marginM: number,
    private readonly parts: readonly string[],
  ) {
    this.surfaceGeoms = surfaces.map((name) => boxes.geoms.get(name) as number);
    this.marks = [...surfaces.keys()].filter((row) => !boxes.isSolid(surfaces[row] as string));
    this.surfaceOf = new Int32Array(table.partOfGeom.length).fill(-1);
    this.surfaceGeoms.forEach((geom, surface) => {
      this.surfaceOf[geom] = surface;
    });
    const rows = new Map(parts.map((part, row) => [part, row]));
    this.partOf = Int32Array.from(table.partOfGeom, (part) => {
      let at = part;
      while (at !== null && !rows.has(at)) at = parentOf(at);
      return at === null ? -1 : (rows.get(at) as number);
    });
    const size = surfaces.length * parts.length;
    this.touched = new Uint8Array(size);
    this.near = new Uint8Array(size);
    this.continuing = new Uint8Array(size);
  }

  /** Fill `touched` and `near` after the simulation's last step; `contacts` was read. */
  read(): void {
    const { touched, near, continuing, contacts, surfaceOf, partOf, parts } = this;
    touched.fill(0);
    for (let row = 0; row < contacts.count; row++) {
      for (const side of BOTH) {
        const surface = surfaceOf[contacts.geom(row, side)] as number;
        if (surface < 0) continue;
        const part = partOf[contacts.geom(row, side === 0 ? 1 : 0)] as number;
        if (part >= 0) touched[surface * parts.length + part] = 1;
      }
    }
    near.set(touched);
    for (let index = 0; index < this.marks.length; index++)
      this.readMark(this.marks[index] as number);
    for (let pair = 0; pair < near.length; pair++) {
      if (continuing[pair] === 1 && near[pair] === 0 && this.isNear(pair)) near[pair] = 1;
      const isTouch = continuing[pair] === 1 || touched[pair] === 1;
      continuing[pair] = near[pair] === 1 && isTouch ? 1 : 0;
    }
  }

  /** Whether the part of a pair is within the margin of its surface. */
  private isNear(pair: number): boolean {
    const surface = Math.floor(pair / this.parts.length);
    const part = pair % this.parts.length;
    const { partOf, views } = this;
    for (let geom = 0; geom < partOf.length; geom++) {
      if (partOf[geom] !== part || views.geomContype[geom] === 0) continue;
      if (this.distanceM(surface, geom) <= this.marginM) return true;
    }
    return false;
  }

  /** A mark stops nothing: parts whose shapes overlap it touch it. */
  private readMark(surface: number): void {
    const { views, partOf, marginM, touched, near } = this;
    const { geomXpos, geomRbound, geomContype } = views;
    const mark = this.surfaceGeoms[surface] as number;
    for (let geom = 0; geom < partOf.length; geom++) {
      const part = partOf[geom] as number;
      if (part < 0 || geomContype[geom] === 0) continue;
      const reachM = (geomRbound[geom] as number) + (geomRbound[mark] as number) + marginM;
      let squared = 0;
      for (let i = 0; i < 3; i++) {
        squared += ((geomXpos[3 * geom + i] as number) - (geomXpos[3 * mark + i] as number)) ** 2;
      }
      if (squared > reachM * reachM) continue;
      const distanceM = this.distanceM(surface, geom);
      const pair = surface * this.parts.length + part;
      if (distanceM <= 0) touched[pair] = 1;
      if (distanceM <= marginM) near[pair] = 1;
    }
  }

  /** The distance of a geom from a surface, at most twice the margin. */
  private distanceM(surface: number, geom: number): number {
    const { mujoco, model, data } = this.views;
    const box = this.surfaceGeoms[surface] as number;
    return mujoco.mj_geomDistance(model, data, geom, box, 2 * this.marginM, null);
  }
}
