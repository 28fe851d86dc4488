/** Colours of body parts over the materials of a skin. This module imports three.js. */
import { Color, type Material, Vector4 } from "three";
import { PART_ATTRIBUTE } from "./bodyModel";

/** How much of the skin's own colour a tint covers. */
const STRENGTH = 0.6;

/** The tints of the parts of one body: red, green, blue and how much they cover. */
export class Tints {
  readonly #values: readonly Vector4[];
  readonly #colour = new Color();

  constructor(parts: number) {
    this.#values = Array.from({ length: Math.max(1, parts) }, () => new Vector4(0, 0, 0, 0));
  }

  set(part: number, colour: string | number): void {
    const { r, g, b } = this.#colour.set(colour);
    this.#values[part]?.set(r, g, b, STRENGTH);
  }

  /** Let a material show the tints; it must not be shared with another body. */
  apply(material: Material): void {
    const before = material.onBeforeCompile;
    const key = material.customProgramCacheKey();
    const count = this.#values.length;
    material.onBeforeCompile = (shader, renderer) => {
      before.call(material, shader, renderer);
      shader.uniforms.partTints = { value: this.#values };
      shader.vertexShader = shader.vertexShader.replace(
        "void main() {",
        `attribute float ${PART_ATTRIBUTE};
        uniform vec4 partTints[${count}];
        varying vec4 partTint;
        void main() {
          partTint = partTints[int(${PART_ATTRIBUTE} + 0.5)];`,
      );
      shader.fragmentShader = tinted(shader.fragmentShader);
    };
    material.customProgramCacheKey = () => `${key} tinted ${count}`;
  }
}

const DECLARED = "varying vec4 partTint;\n";

/**
 * Mix in the tint before the light where three.js has a place for that, so that the body keeps its
 * shape, and otherwise into the final colour (VRM's toon shader).
 */
function tinted(shader: string): string {
  const lit = /^[ \t]*#include <color_fragment>/m;
  if (lit.test(shader)) {
    return (
      DECLARED +
      shader.replace(
        lit,
        "#include <color_fragment>\ndiffuseColor.rgb = mix(diffuseColor.rgb, partTint.rgb, partTint.a);",
      )
    );
  }
  return (
    DECLARED +
    shader.replace(
      /^[ \t]*#include <tonemapping_fragment>/m,
      "gl_FragColor.rgb = mix(gl_FragColor.rgb, partTint.rgb, partTint.a);\n#include <tonemapping_fragment>",
    )
  );
}
