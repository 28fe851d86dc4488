/** Numbers and shapes for the faces of blocks, in one texture. This module imports three.js. */
import { CanvasTexture, LinearFilter, LinearMipmapLinearFilter } from "three";
import type { Cue } from "./appearance";

/** Signs in a row and in a column of the texture. */
export const SIGNS_ACROSS = 4;
const CELL = 256;
/** A study has at most 12 boxes; shapes come behind their numbers. */
export const NUMBERS = 12;
const CUES: readonly Exclude<Cue, "none">[] = ["check", "cross", "ring", "stripes"];

/** The index of a sign in the texture; -1: none. */
export const NO_SIGN = -1;
export const signOfNumber = (number: number): number =>
  number >= 1 && number <= NUMBERS ? number - 1 : NO_SIGN;
export const signOfCue = (cue: Cue): number =>
  cue === "none" ? NO_SIGN : NUMBERS + CUES.indexOf(cue);

/** White signs on nothing: only how much they cover is read. */
export function makeSigns(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = SIGNS_ACROSS * CELL;
  canvas.height = SIGNS_ACROSS * CELL;
  const ink = canvas.getContext("2d");
  if (ink !== null) {
    ink.fillStyle = "#ffffff";
    ink.strokeStyle = "#ffffff";
    for (let sign = 0; sign < SIGNS_ACROSS ** 2; sign++) {
      ink.save();
      ink.translate(
        (sign % SIGNS_ACROSS) * CELL + CELL / 2,
        Math.floor(sign / SIGNS_ACROSS) * CELL + CELL / 2,
      );
      if (sign < NUMBERS) drawNumber(ink, sign + 1);
      else drawCue(ink, CUES[sign - NUMBERS] ?? "ring");
      ink.restore();
    }
  }
  const texture = new CanvasTexture(canvas);
  texture.minFilter = LinearMipmapLinearFilter;
  texture.magFilter = LinearFilter;
  texture.anisotropy = 8;
  return texture;
}

function drawNumber(ink: CanvasRenderingContext2D, number: number): void {
  ink.font = `600 ${number < 10 ? 208 : 150}px system-ui, "Segoe UI", Roboto, sans-serif`;
  ink.textAlign = "center";
  ink.textBaseline = "alphabetic";
  const { actualBoundingBoxAscent: up, actualBoundingBoxDescent: down } = ink.measureText("1");
  ink.fillText(String(number), 0, (up - down) / 2);
}

function drawCue(ink: CanvasRenderingContext2D, cue: Exclude<Cue, "none">): void {
  ink.lineWidth = 30;
  ink.lineCap = "round";
  ink.lineJoin = "round";
  ink.beginPath();
  if (cue === "check") {
    ink.moveTo(-76, 6);
    ink.lineTo(-22, 62);
    ink.lineTo(78, -60);
  } else if (cue === "cross") {
    ink.moveTo(-66, -66);
    ink.lineTo(66, 66);
    ink.moveTo(66, -66);
    ink.lineTo(-66, 66);
  } else if (cue === "ring") {
    ink.arc(0, 0, 70, 0, 2 * Math.PI);
  } else {
    ink.lineWidth = 22;
    ink.rect(-90, -90, 180, 180);
    ink.clip();
    ink.beginPath();
    for (let at = -160; at <= 160; at += 60) {
      ink.moveTo(at - 110, 110);
      ink.lineTo(at + 110, -110);
    }
  }
  ink.stroke();
}
