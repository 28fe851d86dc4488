/**
 * A calm, dim room for pauses: a soft floor, a horizon and nothing else. It hides the scene, and the
 * participant can look around in it as before, because head tracking never stops.
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

const RADIUS_M = 8;
const FLOOR = new Color("#26333a");
const HORIZON = new Color("#38505a");
const ZENITH = new Color("#161e24");

export class PauseRoom {
  readonly object = new Group();

  constructor() {
    const dome = new Mesh(
      shaded(new SphereGeometry(RADIUS_M, 32, 24), (y) =>
        HORIZON.clone().lerp(ZENITH, Math.min(1, Math.max(0, y / (RADIUS_M * 0.8)))),
      ),
      new MeshBasicMaterial({ vertexColors: true, side: BackSide, toneMapped: false }),
    );
    const floor = new CircleGeometry(RADIUS_M, 48).rotateX(-Math.PI / 2);
    const ground = new Mesh(
      shaded(floor, (_, distance) => FLOOR.clone().lerp(HORIZON, distance / RADIUS_M)),
      new MeshBasicMaterial({ vertexColors: true, toneMapped: false }),
    );
    this.object.name = "pause room";
    this.object.add(dome, ground);
    this.object.visible = false;
  }

  dispose(): void {
    for (const child of this.object.children) {
      if (child instanceof Mesh) {
        child.geometry.dispose();
        child.material.dispose();
      }
    }
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
