/**
 * A replay recorded as a video by the browser, while it is played: every stage beside the other,
 * with its name, the time, and what the data are, so that the file explains itself.
 */

/** What is written into the picture; asked for with every frame. */
export interface FilmWords {
  /** A name for each stage. */
  readonly names: readonly string[];
  /** Where the replay is, such as "12.40 s". */
  readonly time: string;
  /** Whose data and under which conditions, in a line. */
  readonly about: string;
  /** Where the data were not made by people; null otherwise. */
  readonly mark: string | null;
}

export interface FilmColours {
  readonly ground: string;
  readonly ink: string;
  readonly soft: string;
  readonly mark: string;
  readonly font: string;
}

export interface Film {
  readonly pause: () => void;
  readonly resume: () => void;
  /** End it; resolves with the file. */
  readonly stop: () => Promise<Blob>;
  /** End it and forget it. */
  readonly cancel: () => void;
}

/** The formats in order of preference; WebM, which every current browser but Safari writes. */
const TYPES = [
  "video/webm;codecs=vp9",
  "video/webm;codecs=vp8",
  "video/webm",
  "video/mp4",
] as const;
const FRAME_RATE_HZ = 30;
const BITS_PER_S = 6_000_000;
const HEIGHT_PX = 720;
const WIDEST_PX = 1920;
const BAND_PX = 40;
const MARGIN_PX = 16;

/** The format that this browser can record in; null if it can record none. */
export function filmType(): string | null {
  if (typeof MediaRecorder === "undefined" || !("captureStream" in HTMLCanvasElement.prototype)) {
    return null;
  }
  return TYPES.find((type) => MediaRecorder.isTypeSupported(type)) ?? null;
}

/** The ending of a file of this format. */
export const endingOf = (type: string): string => (type.startsWith("video/mp4") ? "mp4" : "webm");

/** Even numbers of pixels, which encoders need. */
const even = (px: number): number => 2 * Math.round(px / 2);

export interface Placed {
  readonly left: number;
  readonly width: number;
}

/**
 * The size of the film and the place of every stage in it: all as high as the film, side by side, in
 * the proportions that they have on the page, and together at most 1,920 px wide.
 */
export function filmLayout(aspects: readonly number[]): {
  readonly width: number;
  readonly height: number;
  readonly places: readonly Placed[];
} {
  const total = aspects.reduce((sum, aspect) => sum + aspect, 0);
  const height = Math.min(HEIGHT_PX, WIDEST_PX / total);
  let left = 0;
  const places = aspects.map((aspect) => {
    const placed = { left, width: aspect * height };
    left += placed.width;
    return placed;
  });
  return { width: even(left), height: even(height) + BAND_PX, places };
}

/**
 * Start to record what is drawn on `canvases`; throws if the browser refuses.
 *
 * A canvas is a stage's own, which keeps its picture after it was drawn.
 */
export function startFilm(
  canvases: readonly HTMLCanvasElement[],
  type: string,
  colours: FilmColours,
  words: () => FilmWords,
): Film {
  const { width, height, places } = filmLayout(
    canvases.map((canvas) => canvas.width / Math.max(1, canvas.height)),
  );
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const picture = canvas.getContext("2d", { alpha: false });
  if (picture === null) throw new Error("This browser gives no canvas to record on.");
  const draw = () => drawFrame(picture, canvases, places, colours, words());
  draw();
  const stream = canvas.captureStream(FRAME_RATE_HZ);
  const recorder = new MediaRecorder(stream, {
    mimeType: type,
    videoBitsPerSecond: BITS_PER_S,
  });
  const pieces: Blob[] = [];
  recorder.ondataavailable = ({ data }) => {
    if (data.size > 0) pieces.push(data);
  };
  let request = requestAnimationFrame(function tick() {
    draw();
    request = requestAnimationFrame(tick);
  });
  const tidy = () => {
    cancelAnimationFrame(request);
    for (const track of stream.getTracks()) track.stop();
  };
  // In pieces, so that a long film does not wait in the encoder.
  recorder.start(1000);
  return {
    pause: () => {
      if (recorder.state === "recording") recorder.pause();
    },
    resume: () => {
      if (recorder.state === "paused") recorder.resume();
    },
    stop: () =>
      new Promise((resolve, reject) => {
        recorder.onstop = () => {
          tidy();
          resolve(new Blob(pieces, { type: recorder.mimeType || type }));
        };
        recorder.onerror = () => {
          tidy();
          reject(new Error("The browser could not record the replay."));
        };
        draw();
        recorder.stop();
      }),
    cancel: () => {
      recorder.ondataavailable = null;
      if (recorder.state !== "inactive") recorder.stop();
      tidy();
    },
  };
}

function drawFrame(
  picture: CanvasRenderingContext2D,
  canvases: readonly HTMLCanvasElement[],
  places: readonly Placed[],
  colours: FilmColours,
  { names, time, about, mark }: FilmWords,
): void {
  const { width, height } = picture.canvas;
  const bottom = height - BAND_PX;
  picture.fillStyle = colours.ground;
  picture.fillRect(0, 0, width, height);
  picture.textBaseline = "middle";
  for (const [index, canvas] of canvases.entries()) {
    const placed = places[index];
    if (placed === undefined) continue;
    picture.drawImage(canvas, placed.left, 0, placed.width, bottom);
    if (index > 0) {
      picture.fillStyle = colours.soft;
      picture.fillRect(placed.left, 0, 1, bottom);
    }
    picture.font = `600 18px ${colours.font}`;
    picture.textAlign = "left";
    picture.fillStyle = colours.ink;
    picture.fillText(
      names[index] ?? "",
      placed.left + MARGIN_PX,
      MARGIN_PX + 8,
      placed.width - 2 * MARGIN_PX,
    );
  }
  const middle = bottom + BAND_PX / 2;
  picture.font = `600 18px ${colours.font}`;
  picture.fillStyle = colours.ink;
  picture.fillText(time, MARGIN_PX, middle);
  const timeWidth = picture.measureText("0000.00 s").width;
  if (mark !== null) {
    picture.fillStyle = colours.mark;
    picture.textAlign = "right";
    picture.fillText(mark, width - MARGIN_PX, middle);
  }
  const markWidth = mark === null ? 0 : picture.measureText(mark).width + MARGIN_PX;
  picture.font = `400 16px ${colours.font}`;
  picture.fillStyle = colours.soft;
  picture.textAlign = "left";
  const from = 2 * MARGIN_PX + timeWidth;
  picture.fillText(about, from, middle, Math.max(1, width - from - markWidth - MARGIN_PX));
}
