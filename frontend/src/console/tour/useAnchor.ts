/** Where something on the page is, followed while the page scrolls, grows and changes under it. */
import { useEffect, useState } from "react";
import { anchorOf, type TourStep } from "./tourStore";

export interface Place {
  readonly top: number;
  readonly left: number;
  readonly width: number;
  readonly height: number;
}

const LOOK_EVERY_MS = 150;
const MARGIN = 6;

export function useAnchor(step: TourStep): Place | null {
  const [place, setPlace] = useState<Place | null>(null);
  useEffect(() => {
    const anchor = anchorOf(step);
    // At once: a callout that chases what is scrolled is hard to read.
    anchor?.scrollIntoView({ block: "nearest" });
    const look = () => setPlace((known) => same(known, placeOf(anchorOf(step))));
    look();
    // What is pointed at may come, go and move with the session, which no event tells.
    const timer = setInterval(look, LOOK_EVERY_MS);
    window.addEventListener("resize", look);
    return () => {
      clearInterval(timer);
      window.removeEventListener("resize", look);
    };
  }, [step]);
  return place;
}

/** The part of it that is in the window, with a little room around. */
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

function same(known: Place | null, found: Place | null): Place | null {
  if (known === null || found === null) return found;
  const moved = (["top", "left", "width", "height"] as const).some(
    (side) => Math.abs(known[side] - found[side]) > 0.5,
  );
  return moved ? found : known;
}
