/**
 * The comfort fade: the room gives way to one calm colour within 200 ms, and comes back. The head
 * stays tracked all the time, and what is in front of the curtain (panels) stays visible. This
 * module imports three.js.
 */
import { BufferGeometry, Color, Float32BufferAttribute, Mesh, ShaderMaterial } from "three";

export const FADE_S = 0.2;
const COLOUR = new Color("#3b4145");

export class Curtain {
  /** One triangle over the whole view of each eye. */
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  #share = 0;
  #timeS = Number.NaN;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute(
      "position",
      new Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3),
    );
    const material = new ShaderMaterial({
      uniforms: { colour: { value: COLOUR }, share: { value: 0 } },
      vertexShader: "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: `uniform vec3 colour;
        uniform float share;
        void main() {
          gl_FragColor = vec4(colour, share);
          #include <colorspace_fragment>
        }`,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = CURTAIN_ORDER;
    this.mesh.visible = false;
  }

  /** How much is hidden, 0 to 1. */
  get share(): number {
    return this.#share;
  }

  /**
   * Move towards hiding everything or nothing; at least `least` is hidden. `isAtOnce`: hide all of
   * it in this frame.
   */
  show(timeS: number, isDrawn: boolean, least = 0, isAtOnce = false): void {
    const passed = Number.isNaN(this.#timeS) ? FADE_S : Math.max(0, timeS - this.#timeS);
    this.#timeS = timeS;
    const way = passed / FADE_S;
    this.#share = isAtOnce ? 1 : Math.min(1, Math.max(0, this.#share + (isDrawn ? way : -way)));
    const shown = Math.max(this.#share, least);
    const { share } = this.mesh.material.uniforms;
    if (share !== undefined) share.value = shown * shown * (3 - 2 * shown);
    this.mesh.visible = shown > 0;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** The order in which three.js draws what is transparent: the room, the curtain, panels. */
export const CURTAIN_ORDER = 50;
export const PANELS_ORDER = 100;
