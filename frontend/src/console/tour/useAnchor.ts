/** The position of an element, followed while the page scrolls, grows and changes. */
import { useEffect, useState } from "react";
import { anchorOf, type TourStep } from "./tourStore";

export interface Place {
  readonly top: number;
  readonly left: number;
  readonly width: number;
  readonly height: number;
}

const UPDATE_EVERY_MS = 150;
const MARGIN = 6;

export function useAnchor(step: TourStep): Place | null {
  const [place, setPlace] = useState<Place | null>(null);
  useEffect(() => {
    const anchor = anchorOf(step);
    // Without animation: a callout that follows a scrolling target is hard to read.
    anchor?.scrollIntoView({ block: "nearest" });
    const update = () => setPlace((previous) => same(previous, placeOf(anchorOf(step))));
    update();
    // The target may appear, disappear and move with the session, which no event reports.
    const timer = setInterval(update, UPDATE_EVERY_MS);
    window.addEventListener("resize", update);
    return () => {
      clearInterval(timer);
      window.removeEventListener("resize", update);
    };
  }, [step]);
  return place;
}

/** The part of the target that is inside the window, with a small margin. */
function placeOf(anchor: HTMLElement | null): Place | null {
  if (anchor === null) return null;
  const box = anchor.getBoundingClientRect();
  const top = Math.max(2, box.top - MARGIN);
  const left = Math.max(2, box.left - MARGIN);
  const bottom = Math.min(window.innerHeight - 2, box.bottom + MARGIN);
  const right = Math.min(window.innerWidth - 2, box.right + MARGIN);
  if (bottom <= top || right <= left) return null;
  return { top, left, width: right - left, height: bottom - top };
}

function same(previous: Place | null, found: Place | null): Place | null {
  if (previous === null || found === null) return found;
  const moved = (["top", "left", "width", "height"] as const).some(
    (side) => Math.abs(previous[side] - found[side]) > 0.5,
  );
  return moved ? found : previous;
}
