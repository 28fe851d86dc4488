/**
 * Small pictures of bodies for lists, drawn in the browser one after the other. Each is drawn once
 * for each colour scheme; a large body has none, because its file would have to be fetched for it.
 */
import { useComputedColorScheme } from "@mantine/core";
import { paletteOf } from "@shared/stage/figure";
import type { Seconds } from "@shared/units";
import { useEffect, useState } from "react";
import { example } from "../bodyView/examplePoses";
import { AVATAR_MAP, rolesFrom } from "../captures/bodyJoints";

const LARGEST_BYTES = 24 * 1024 ** 2;
const WIDTH_PX = 320;
const HEIGHT_PX = 360;
/** Distance of the camera relative to the usual one: heads may be larger than a person's. */
const ROOM = 1.15;

const drawn = new Map<string, Promise<string | null>>();
let last: Promise<unknown> = Promise.resolve();

export function useBodyPicture(hash: string, bytes: number): string | null {
  const scheme = useComputedColorScheme("light");
  const [picture, setPicture] = useState<string | null>(null);
  useEffect(() => {
    if (bytes > LARGEST_BYTES) return;
    let isGone = false;
    const key = `${hash} ${scheme}`;
    let one = drawn.get(key);
    if (one === undefined) {
      one = last.then(() => draw(hash)).catch(() => null);
      last = one;
      drawn.set(key, one);
    }
    void one.then((url) => {
      if (!isGone) setPicture(url);
    });
    return () => {
      isGone = true;
    };
  }, [hash, bytes, scheme]);
  return picture;
}

async function draw(hash: string): Promise<string | null> {
  const { takeBody } = await import("@shared/stage/skin/loadBody");
  const { Stage3d } = await import("@shared/stage/scene");
  const { loading, release } = takeBody(hash);
  try {
    const model = await loading;
    const statureM = model.binding.stature_m;
    const { motion, pose } = example(model.binding, statureM, "stand");
    const canvas = document.createElement("canvas");
    const stage = new Stage3d(canvas);
    try {
      stage.resize(WIDTH_PX, HEIGHT_PX);
      const roles = rolesFrom(motion.names, AVATAR_MAP);
      const worn = { model, statureM, pose };
      const figure = { key: hash, motion, tone: "solid", roles, worn } as const;
      stage.setFigures([figure], paletteOf(document.body));
      stage.show(0 as Seconds);
      stage.placeCamera("front");
      stage.zoom(ROOM);
      // Draws immediately.
      stage.resize(WIDTH_PX, HEIGHT_PX);
      return canvas.toDataURL("image/webp", 0.9);
    } finally {
      stage.dispose();
    }
  } finally {
    release();
  }
}
