/** Mouse and keyboard of a page, as what a participant on the desktop does. */
import { DESKTOP_KEYS, type DesktopSource } from "../tracking";

const SELECT_BUTTON = 0;
const REACH_BUTTON = 2;

/** Let an element's mouse and the page's keyboard direct the source; returns how to stop. */
export function listenTo(element: HTMLElement, source: DesktopSource): () => void {
  const { controls } = source;
  const isLocked = (): boolean => document.pointerLockElement === element;
  const letGo = (): void => controls.releaseAll();
  const onButton = (event: MouseEvent): void => {
    const isDown = event.type === "mousedown";
    if (isDown && !isLocked()) {
      // The first click only takes the mouse.
      void Promise.resolve(element.requestPointerLock()).catch(() => undefined);
      return;
    }
    if (event.button === SELECT_BUTTON) controls.select(isDown);
    if (event.button === REACH_BUTTON) controls.isReaching = isDown;
  };
  const onMove = (event: MouseEvent): void => {
    if (isLocked()) controls.look(event.movementX, event.movementY);
  };
  const onWheel = (event: WheelEvent): void => {
    event.preventDefault();
    controls.wheel(event.deltaY);
  };
  const onKey = (event: KeyboardEvent): void => {
    const action = DESKTOP_KEYS[event.code];
    if (action === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (event.type === "keyup") controls.release(action);
    else if (!event.repeat) controls.press(action);
  };
  const onLock = (): void => {
    if (!isLocked()) letGo();
  };
  const onMenu = (event: Event): void => event.preventDefault();
  const stopping = new AbortController();
  const { signal } = stopping;
  element.addEventListener("mousedown", onButton, { signal });
  element.addEventListener("contextmenu", onMenu, { signal });
  element.addEventListener("wheel", onWheel, { signal, passive: false });
  window.addEventListener("mouseup", onButton, { signal });
  window.addEventListener("mousemove", onMove, { signal });
  window.addEventListener("keydown", onKey, { signal });
  window.addEventListener("keyup", onKey, { signal });
  window.addEventListener("blur", letGo, { signal });
  document.addEventListener("pointerlockchange", onLock, { signal });
  return () => {
    stopping.abort();
    if (isLocked()) document.exitPointerLock();
  };
}
