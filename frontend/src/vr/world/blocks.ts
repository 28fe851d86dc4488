/**
 * Solid blocks with edges and signs, and their reflections, in one draw call. This module imports
 * three.js.
 *
 * The reflection of a block is again a block, elsewhere and turned otherwise, so both are instances
 * of the same cube; only the signs on its faces are reversed, as in a mirror.
 */
import {
  BoxGeometry,
  Color,
  DynamicDrawUsage,
  InstancedBufferAttribute,
  InstancedMesh,
  Matrix4,
  MeshLambertMaterial,
  Quaternion,
  type Texture,
  Vector3,
} from "three";
import type { Mirror } from "./mirror";
import { NO_SIGN, NUMBERS, SIGNS_ACROSS } from "./signs";

/** Where a block is: metres and radians. */
export interface BlockPlace {
  readonly centerM: readonly [number, number, number];
  readonly halfSizeM: readonly [number, number, number];
  /** Turned about the x axis; 0 by default. */
  readonly tiltRad?: number;
}

const DARK_INK = new Color("#1d2729");
const LIGHT_INK = new Color("#ffffff");

export class Blocks {
  readonly mesh: InstancedMesh<BoxGeometry, MeshLambertMaterial>;
  readonly #count: number;
  readonly #signs: InstancedBufferAttribute;
  readonly #inks: InstancedBufferAttribute;
  readonly #mirror: Mirror | null;
  readonly #colour = new Color();
  readonly #painted: { colour: string; sign: number }[];

  /** `count` blocks, invisible until they are placed; without a mirror, no reflections. */
  constructor(count: number, signs: Texture, mirror: Mirror | null) {
    this.#count = count;
    this.#mirror = mirror;
    this.#painted = Array.from({ length: count }, () => ({ colour: "", sign: NO_SIGN }));
    const all = mirror === null ? count : 2 * count;
    const geometry = new BoxGeometry(1, 1, 1);
    this.#signs = new InstancedBufferAttribute(new Float32Array(all).fill(NO_SIGN), 1);
    this.#inks = new InstancedBufferAttribute(new Float32Array(3 * all), 3);
    const reversed = Float32Array.from({ length: all }, (_, at) => Number(at >= count));
    geometry.setAttribute("signIndex", this.#signs);
    geometry.setAttribute("ink", this.#inks);
    geometry.setAttribute("reversed", new InstancedBufferAttribute(reversed, 1));
    this.mesh = new InstancedMesh(geometry, makeMaterial(signs), all);
    this.mesh.frustumCulled = false;
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    const nothing = new Matrix4().makeScale(0, 0, 0);
    for (let at = 0; at < all; at++) {
      this.mesh.setMatrixAt(at, nothing);
      this.mesh.setColorAt(at, LIGHT_INK);
    }
  }

  /** Put a block somewhere; null hides it. */
  place(block: number, place: BlockPlace | null): void {
    const { mesh } = this;
    mesh.instanceMatrix.needsUpdate = true;
    if (place === null) {
      MATRIX.makeScale(0, 0, 0);
      mesh.setMatrixAt(block, MATRIX);
      if (this.#mirror !== null) mesh.setMatrixAt(this.#count + block, MATRIX);
      return;
    }
    POINT.set(...place.centerM);
    SIZE.set(...place.halfSizeM).multiplyScalar(2);
    TURN.setFromAxisAngle(X, place.tiltRad ?? 0);
    mesh.setMatrixAt(block, MATRIX.compose(POINT, TURN, SIZE));
    if (this.#mirror === null) return;
    MATRIX.compose(this.#mirror.reflectPoint(POINT), this.#mirror.reflectRotation(TURN), SIZE);
    mesh.setMatrixAt(this.#count + block, MATRIX);
  }

  /** Give a block a colour and a sign; nothing is sent to the graphics card if both are as before. */
  paint(block: number, colour: string, sign: number): void {
    const { mesh } = this;
    const painted = this.#painted[block];
    if (painted === undefined || (painted.colour === colour && painted.sign === sign)) return;
    painted.colour = colour;
    painted.sign = sign;
    this.#colour.set(colour);
    const ink = luminance(this.#colour) > 0.3 ? DARK_INK : LIGHT_INK;
    for (const at of this.#mirror === null ? [block] : [block, this.#count + block]) {
      mesh.setColorAt(at, this.#colour);
      this.#signs.setX(at, sign);
      this.#inks.setXYZ(at, ink.r, ink.g, ink.b);
    }
    if (mesh.instanceColor !== null) mesh.instanceColor.needsUpdate = true;
    this.#signs.needsUpdate = true;
    this.#inks.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.dispose();
  }
}

const MATRIX = new Matrix4();
const POINT = new Vector3();
const SIZE = new Vector3();
const TURN = new Quaternion();
const X = new Vector3(1, 0, 0);

/** Relative luminance of a colour in linear light (ITU-R BT.709). */
const luminance = ({ r, g, b }: Color): number => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/** Edges are lines of this width on each face, metres. */
const EDGE_M = 0.0022;
/** No sign on a face whose shorter side is below this, metres. */
const SMALLEST_FACE_M = 0.03;
/** The share of a face that a sign's square covers. */
const SIGN_SHARE = 0.86;

function makeMaterial(signs: Texture): MeshLambertMaterial {
  const material = new MeshLambertMaterial();
  material.onBeforeCompile = (shader) => {
    shader.uniforms.signs = { value: signs };
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", `#include <common>\n${VERTEX_HEAD}`)
      .replace("#include <begin_vertex>", `#include <begin_vertex>\n${VERTEX}`);
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", `#include <common>\n${FRAGMENT_HEAD}`)
      .replace("#include <color_fragment>", `#include <color_fragment>\n${FRAGMENT}`);
  };
  material.customProgramCacheKey = () => "blocks";
  return material;
}

const VERTEX_HEAD = `
attribute float signIndex;
attribute vec3 ink;
attribute float reversed;
varying vec2 vFace;
varying vec2 vHalf;
varying vec2 vMirrored;
flat varying float vSign;
varying vec3 vInk;`;

// The face's two axes, in metres: its size comes from the instance's scale.
const VERTEX = `
vec3 boxSize = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));
vec2 faceSize = abs(normal.x) > 0.5 ? boxSize.zy : abs(normal.y) > 0.5 ? boxSize.xz : boxSize.xy;
vHalf = 0.5 * faceSize;
vFace = (uv - 0.5) * faceSize;
vMirrored = reversed < 0.5 ? vec2(1.0) : abs(normal.y) > 0.5 ? vec2(1.0, -1.0) : vec2(-1.0, 1.0);
vSign = signIndex;
vInk = ink;`;

const FRAGMENT_HEAD = `
uniform sampler2D signs;
varying vec2 vFace;
varying vec2 vHalf;
varying vec2 vMirrored;
flat varying float vSign;
varying vec3 vInk;`;

const FRAGMENT = `
float shorter = min(vHalf.x, vHalf.y);
vec2 toEdge = vHalf - abs(vFace);
float edge = min(toEdge.x, toEdge.y);
float line = clamp((${EDGE_M} - edge) / max(fwidth(edge), 1e-5) + 0.5, 0.0, 1.0);
float cell = max(vSign, 0.0);
// A shape is repeated along a long face; a number is not.
vec2 times = vec2(1.0);
if (cell > ${NUMBERS}.0 - 0.5) times = max(vec2(1.0), floor(vHalf / shorter / 1.6 + 0.2));
vec2 apart = 2.0 * vHalf / times;
vec2 fromMiddle = mod(vFace + vHalf, apart) - 0.5 * apart;
vec2 onSign = clamp(fromMiddle * vMirrored / (${SIGN_SHARE} * shorter), -1.0, 1.0) * 0.5 + 0.5;
vec2 corner = vec2(mod(cell, ${SIGNS_ACROSS}.0), ${SIGNS_ACROSS}.0 - 1.0 - floor(cell / ${SIGNS_ACROSS}.0));
// Where one repetition ends and the next begins, the texture's coordinates jump.
vec2 unbroken = vFace / (${2 * SIGN_SHARE * SIGNS_ACROSS} * shorter);
float covered = textureGrad(signs, (corner + onSign) / ${SIGNS_ACROSS}.0, dFdx(unbroken), dFdy(unbroken)).a;
if (vSign < -0.5 || shorter < ${SMALLEST_FACE_M / 2}) covered = 0.0;
diffuseColor.rgb = mix(diffuseColor.rgb, vInk, covered);
diffuseColor.rgb = mix(diffuseColor.rgb, diffuseColor.rgb * 0.42, line);`;
