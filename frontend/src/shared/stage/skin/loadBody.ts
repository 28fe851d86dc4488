/**
 * Load bodies: the file and the binding of a model, by the hash of its content. A body that several
 * figures wear is loaded once. This module imports three.js: import it lazily.
 */
import { bodies } from "../../api/bodies";
import type { BodyModel } from "./bodyModel";
import { readBody } from "./readBody";

/** How long a body that nobody wears is kept, so that another page need not load it again. */
const KEPT_MS = 10_000;

interface Held {
  readonly loading: Promise<BodyModel>;
  users: number;
  timer: ReturnType<typeof setTimeout> | undefined;
}

const held = new Map<string, Held>();

/** Load a body, or take it if it is loaded already; `release` it afterwards. */
export function takeBody(hash: string): {
  readonly loading: Promise<BodyModel>;
  readonly release: () => void;
} {
  let one = held.get(hash);
  if (one === undefined) {
    one = { loading: load(hash), users: 0, timer: undefined };
    held.set(hash, one);
    const fresh = one;
    // A body that could not be loaded, or not as a whole, is tried again by the next who wants it.
    const forget = () => {
      if (held.get(hash) === fresh) held.delete(hash);
    };
    fresh.loading.then(({ missing }) => {
      if (missing.isDecoderMissing) forget();
    }, forget);
  }
  const taken = one;
  clearTimeout(taken.timer);
  taken.users++;
  let released = false;
  const release = () => {
    if (released) return;
    released = true;
    taken.users--;
    if (taken.users > 0) return;
    taken.timer = setTimeout(() => {
      if (held.get(hash) === taken) held.delete(hash);
      taken.loading.then((model) => model.dispose()).catch(() => {});
    }, KEPT_MS);
  };
  return { loading: taken.loading, release };
}

async function load(hash: string): Promise<BodyModel> {
  const [file, binding] = await Promise.all([bodies.file(hash), bodies.binding(hash)]);
  return readBody(file, binding);
}
