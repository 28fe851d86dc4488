/** The light of the room. This module imports three.js. */
import { DirectionalLight, Group, HemisphereLight } from "three";

/**
 * Calm light from above, the same towards +z and -z: what stands behind the glass must be lit as
 * what it is the reflection of, and no shader knows that it draws a reflection.
 */
export function makeLights(): Group {
  const lights = new Group();
  lights.add(new HemisphereLight("#ffffff", "#b9b2a8", 1.55));
  for (const z of [1, -1]) {
    const light = new DirectionalLight("#fff6ea", 0.95);
    light.position.set(-0.45, 1.1, z);
    lights.add(light);
  }
  return lights;
}
