/**
 * Another person in the room: their body and its reflection, which the participant's eyes see whole.
 * This module imports three.js.
 */
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { Group } from "three";
import { type Body3d, PlainBody, SkinnedBody } from "./bodies3d";
import type { Mirror } from "./mirror";

export class Companion {
  readonly group = new Group();
  readonly #mirror: Mirror | null;
  #body: Body3d | null = null;

  constructor(mirror: Mirror | null) {
    this.#mirror = mirror;
    this.group.visible = false;
  }

  /** Be a body of this stature, with a model or as a plain one; null: nobody. */
  be(statureM: number | null, model: BodyModel | null): void {
    if (this.#body !== null) {
      this.group.remove(this.#body.group);
      this.#body.dispose();
    }
    this.#body = statureM === null ? null : bodyOf(statureM, model, this.#mirror);
    if (this.#body !== null) this.group.add(this.#body.group);
  }

  /** Be seen in a pose, or not at all; returns the body if it is seen. */
  show(pose: ArrayLike<number> | null): Body3d | null {
    this.group.visible = pose !== null;
    if (pose === null || this.#body === null) return null;
    this.#body.move(pose, null);
    return this.#body;
  }

  dispose(): void {
    this.be(null, null);
  }
}

function bodyOf(statureM: number, model: BodyModel | null, mirror: Mirror | null): Body3d {
  return model === null
    ? new PlainBody(statureM, "own", mirror)
    : new SkinnedBody({ model }, statureM, "own", mirror);
}
