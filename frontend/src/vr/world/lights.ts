/** The light of the room. This module imports three.js. */
import { DirectionalLight, Group, HemisphereLight } from "three";

/**
 * Calm light from above, the same towards +z and -z: what stands behind the glass must be lit as
 * what it is the reflection of, and no shader knows that it draws a reflection.
 */
export function makeLights(): Group {
  const lights = new Group();
  lights.add(new HemisphereLight("#ffffff", "#e2ded7", 2.35));
  for (const z of [1, -1]) {
    const light = new DirectionalLight("#fff8ee", 0.52);
    light.position.set(-0.3, 0.9, 0.75 * z);
    lights.add(light);
  }
  return lights;
}
