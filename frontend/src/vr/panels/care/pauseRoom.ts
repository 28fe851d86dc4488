/**
 * A calm, dim room for pauses: a soft floor, a horizon and nothing else.
 *
 * It is drawn over the curtain that hides the scene, so that the participant keeps a floor and an
 * upright while nothing else is there. The head stays tracked all the time.
 */
import {
  BackSide,
  CircleGeometry,
  Color,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
} from "three";
import { PANELS_ORDER } from "../../world";

const RADIUS_M = 8;
const FADE_S = 0.4;
const FLOOR = new Color("#303e44");
const HORIZON = new Color("#46575e");
const ZENITH = new Color("#242d32");

export class PauseRoom {
  readonly object = new Group();
  readonly #material = new MeshBasicMaterial({
    vertexColors: true,
    side: BackSide,
    transparent: true,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
    fog: false,
  });
  #share = 0;
  #timeS = Number.NaN;

  constructor() {
    const dome = shaded(new SphereGeometry(RADIUS_M, 32, 32), (y) =>
      HORIZON.clone().lerp(ZENITH, Math.min(1, Math.abs(y) / (RADIUS_M * 0.7))),
    );
    // Its face looks down: BackSide shows it from above.
    const floor = shaded(new CircleGeometry(RADIUS_M, 48).rotateX(Math.PI / 2), (_, distance) =>
      FLOOR.clone().lerp(HORIZON, Math.min(1, distance / RADIUS_M)),
    );
    for (const [at, geometry] of [dome, floor].entries()) {
      const mesh = new Mesh(geometry, this.#material);
      mesh.renderOrder = PANELS_ORDER - 10 + at;
      this.object.add(mesh);
    }
    this.object.name = "pause room";
    this.object.visible = false;
  }

  /** Appear or disappear within 0.4 s. */
  show(timeS: number, isShown: boolean): void {
    const passed = Number.isNaN(this.#timeS) ? 0 : Math.max(0, timeS - this.#timeS);
    this.#timeS = timeS;
    const way = passed / FADE_S;
    this.#share = Math.min(1, Math.max(0, this.#share + (isShown ? way : -way)));
    this.#material.opacity = this.#share;
    this.object.visible = this.#share > 0;
  }

  dispose(): void {
    this.#material.dispose();
    for (const child of this.object.children) if (child instanceof Mesh) child.geometry.dispose();
  }
}

/** Give every vertex a colour by its height and its distance from the middle. */
function shaded<Shape extends SphereGeometry | CircleGeometry>(
  shape: Shape,
  colourAt: (y: number, distance: number) => Color,
): Shape {
  const position = shape.getAttribute("position");
  const colours: number[] = [];
  for (let at = 0; at < position.count; at += 1) {
    const distance = Math.hypot(position.getX(at), position.getZ(at));
    colours.push(...colourAt(position.getY(at), distance).toArray());
  }
  shape.setAttribute("color", new Float32BufferAttribute(colours, 3));
  return shape;
}
