import { afterEach, describe, expect, it, vi } from "vitest";
import { dismiss, fetchPart, isUnloaded, reasonFound, reload, reportUnloaded } from "./unloaded";

const PAGE = '<script type="module" crossorigin src="/assets/console-NEW.js"></script>';
const reloaded = vi.fn();

/** A page with this script, at a server that answers in this way. */
function open(script: string, answer: () => Promise<Response>): void {
  vi.stubGlobal("window", { location: { pathname: "/", reload: reloaded } });
  const element = { getAttribute: () => script };
  vi.stubGlobal("document", { querySelector: () => element });
  vi.stubGlobal("fetch", answer);
}

const answers = async () => new Response(PAGE);
const silence = () => Promise.reject(new TypeError("Failed to fetch"));

afterEach(() => {
  vi.unstubAllGlobals();
  reloaded.mockClear();
  dismiss();
});

describe("a part of a page that could not be loaded", () => {
  it.each([
    ["older", "/assets/console-OLD.js", answers],
    ["unknown", "/assets/console-NEW.js", answers],
    ["unreachable", "/assets/console-NEW.js", silence],
    ["unreachable", "/assets/console-OLD.js", async () => new Response("", { status: 502 })],
  ])("is %s for a page with %s", async (reason, script, answer) => {
    open(script, answer);
    const error = new TypeError("Failed to fetch dynamically imported module: /assets/Page.js");
    expect(isUnloaded(error)).toBe(false);
    reportUnloaded(error);
    expect(isUnloaded(error)).toBe(true);
    await vi.waitFor(() => expect(reasonFound()).toBe(reason));
  });

  it("is fetched again with the page only if the server answers", async () => {
    open("/assets/console-OLD.js", silence);
    await reload();
    expect(reloaded).not.toHaveBeenCalled();
    open("/assets/console-OLD.js", answers);
    await reload();
    expect(reloaded).toHaveBeenCalledOnce();
  });

  it("may be something else than a script", async () => {
    open("/assets/console-OLD.js", async () => new Response("gone", { status: 404 }));
    const error: unknown = await fetchPart("/assets/mujoco.wasm").catch((reason) => reason);
    expect(isUnloaded(error)).toBe(true);
    expect(String(error)).toContain("HTTP 404");
  });
});
