/**
 * Addresses whose search stands behind the page's route: `#/studies/a/dashboard?kind=test`.
 *
 * The router reads `?kind=test#/studies/a/dashboard`; but the other form is what a link holds that is
 * opened in another tab, what people write by hand, and what older messages contain.
 */

/** A replay keeps its phase and its moment behind its route: they change as it plays. */
const KEPT = /^#\/sessions\/[^/]+\/replay/;

/** The same address as the router reads it; null where it is so already. */
export function withSearchInFront(href: string): string | null {
  const url = new URL(href);
  const at = url.hash.indexOf("?");
  if (at < 0 || KEPT.test(url.hash)) return null;
  const [route, search] = [url.hash.slice(0, at), url.hash.slice(at)];
  url.hash = route;
  url.search = search;
  return url.href;
}

/** From now on both forms of an address open the same page; called before the router is drawn. */
export function acceptSearchBehindHash(): void {
  const move = () => {
    const moved = withSearchInFront(window.location.href);
    if (moved !== null) history.replaceState(history.state, "", moved);
  };
  move();
  // Before the router, which listens as soon as it is drawn.
  window.addEventListener("hashchange", move);
}
