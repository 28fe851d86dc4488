/**
 * The board above the mirror: the remaining time and the completed tasks, in one draw call. This
 * module imports three.js.
 *
 * Its texture is drawn once; when a digit changes, only the corners that point into it do.
 */
import {
  BufferGeometry,
  CanvasTexture,
  DynamicDrawUsage,
  Float32BufferAttribute,
  LinearMipmapLinearFilter,
  Mesh,
  MeshBasicMaterial,
  SRGBColorSpace,
} from "three";
import type { Mirror } from "./mirror";

export interface BoardWords {
  readonly timeLeft: string;
  readonly completed: string;
}

const WORDS: Readonly<Record<string, BoardWords>> = {
  en: { timeLeft: "Time left", completed: "Tasks completed" },
  de: { timeLeft: "Verbleibende Zeit", completed: "Geschaffte Aufgaben" },
};

/** Words in the participant's language; English where a language is missing. */
export const boardWords = (language: string): BoardWords =>
  WORDS[language] ?? WORDS.en ?? { timeLeft: "", completed: "" };

/** Pixels of the texture: a row of glyphs, then a row for each label. */
const WIDTH = 1024;
const HEIGHT = 512;
const GLYPHS = "0123456789:";
const GLYPH = { width: 80, height: 128 } as const;
const LABEL = { width: 768, height: 96 } as const;

/** Metres on the wall: 24 mm for each metre of distance, and more. */
const GLYPH_M = { width: 0.075, height: 0.12 } as const;
const LABEL_M = { width: 0.48, height: 0.06 } as const;
const GAP_M = 0.055;
/** A quad that shows none of the texture. */
const NOTHING = { width: 0, height: 0 } as const;
const LABELS = 2;
const TIME_GLYPHS = 5;
const COUNT_GLYPHS = 3;

export class Board {
  readonly mesh: Mesh<BufferGeometry, MeshBasicMaterial>;
  readonly #uvs: Float32BufferAttribute;
  #shown = "";
  #words: BoardWords;

  constructor(mirror: Mirror, words: BoardWords) {
    this.#words = words;
    const geometry = new BufferGeometry();
    const quads = LABELS + TIME_GLYPHS + COUNT_GLYPHS;
    this.#uvs = new Float32BufferAttribute(new Float32Array(8 * quads), 2);
    this.#uvs.setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", new Float32BufferAttribute(this.#corners(mirror), 3));
    geometry.setAttribute("uv", this.#uvs);
    const corners = Array.from({ length: quads }, (_, at) => 4 * at);
    geometry.setIndex(corners.flatMap((at) => [at, at + 1, at + 2, at, at + 2, at + 3]));
    const material = new MeshBasicMaterial({
      map: texture(words),
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.matrixAutoUpdate = false;
    this.mesh.visible = false;
  }

  /** Other words from now on; nothing happens if they are the same. */
  speak(words: BoardWords): void {
    if (words.timeLeft === this.#words.timeLeft) return;
    this.#words = words;
    this.mesh.material.map?.dispose();
    this.mesh.material.map = texture(words);
  }

  /** Seconds are counted down as people do: 0:01 lasts until there is no time left. */
  show(remainingS: number | null, completed: number | null): void {
    this.mesh.visible = remainingS !== null || completed !== null;
    if (!this.mesh.visible) return;
    const seconds = Math.ceil(Math.max(0, (remainingS ?? 0) - 1e-6));
    const time =
      remainingS === null
        ? ""
        : `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
    const count = completed === null ? "" : String(completed);
    const text = time.padEnd(TIME_GLYPHS) + count.padEnd(COUNT_GLYPHS);
    if (text === this.#shown) return;
    this.#shown = text;
    [time, count].forEach((value, label) => {
      const { width, height } = value === "" ? NOTHING : LABEL;
      this.#point(label, 0, GLYPH.height + label * LABEL.height, width, height);
    });
    for (let at = 0; at < text.length; at++) {
      const glyph = GLYPHS.indexOf(text[at] ?? " ");
      const { width, height } = glyph < 0 ? NOTHING : GLYPH;
      this.#point(LABELS + at, Math.max(0, glyph) * GLYPH.width, 0, width, height);
    }
    this.#uvs.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.map?.dispose();
    this.mesh.material.dispose();
  }

  /** Let a quad show a rectangle of the texture, in pixels from its upper left corner. */
  #point(quad: number, left: number, top: number, width: number, height: number): void {
    const [x0, x1] = [left / WIDTH, (left + width) / WIDTH];
    const [y0, y1] = [1 - (top + height) / HEIGHT, 1 - top / HEIGHT];
    [
      [x0, y0],
      [x1, y0],
      [x1, y1],
      [x0, y1],
    ].forEach(([x = 0, y = 0], corner) => {
      this.#uvs.setXY(4 * quad + corner, x, y);
    });
  }

  /** Time at the mirror's left edge, the count from its middle on; labels above figures. */
  #corners({ planeZM, widthM, heightM }: Mirror): number[] {
    const z = planeZM + 0.004;
    const low = heightM + GAP_M + 0.02;
    const above = low + GLYPH_M.height;
    const corners: number[] = [];
    const add = (x: number, y: number, width: number, height: number) => {
      corners.push(x, y, z, x + width, y, z, x + width, y + height, z, x, y + height, z);
    };
    const starts = [-widthM / 2, 0.08] as const;
    for (const x of starts) add(x, above, LABEL_M.width, LABEL_M.height);
    starts.forEach((x, field) => {
      const glyphs = field === 0 ? TIME_GLYPHS : COUNT_GLYPHS;
      for (let at = 0; at < glyphs; at++) {
        add(x + at * GLYPH_M.width, low, GLYPH_M.width, GLYPH_M.height);
      }
    });
    return corners;
  }
}

const FONT = 'system-ui, "Segoe UI", Roboto, sans-serif';
const INK = "#2b3335";

function texture({ timeLeft, completed }: BoardWords): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = WIDTH;
  canvas.height = HEIGHT;
  const ink = canvas.getContext("2d");
  if (ink !== null) {
    ink.fillStyle = INK;
    ink.textBaseline = "middle";
    ink.textAlign = "center";
    ink.font = `600 118px ${FONT}`;
    [...GLYPHS].forEach((glyph, at) => {
      ink.fillText(glyph, (at + 0.5) * GLYPH.width, GLYPH.height / 2 + 6);
    });
    ink.textAlign = "left";
    ink.font = `500 60px ${FONT}`;
    [timeLeft, completed].forEach((label, at) => {
      const middle = GLYPH.height + (at + 0.5) * LABEL.height;
      ink.fillText(label, 8, middle + 4, LABEL.width - 16);
    });
  }
  const made = new CanvasTexture(canvas);
  made.colorSpace = SRGBColorSpace;
  made.minFilter = LinearMipmapLinearFilter;
  made.anisotropy = 4;
  return made;
}
