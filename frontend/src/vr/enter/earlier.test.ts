import { beforeEach, describe, expect, it } from "vitest";
import { type Sent, sendEarlier } from "./earlier";
import {
  earlierPairings,
  forgetPairing,
  type Pairing,
  rememberEarlier,
  storedPairing,
  storePairing,
} from "./pairing";

/** The storage of a browser, in memory. */
class Memory implements Storage {
  readonly #items = new Map<string, string>();
  get length() {
    return this.#items.size;
  }
  clear = () => this.#items.clear();
  key = (at: number) => [...this.#items.keys()][at] ?? null;
  getItem = (key: string) => this.#items.get(key) ?? null;
  setItem = (key: string, value: string) => void this.#items.set(key, value);
  removeItem = (key: string) => void this.#items.delete(key);
}

const A: Pairing = { sessionId: "a", token: "token-a", code: "4FQ-7KP" };
const B: Pairing = { sessionId: "b", token: "token-b" };
const optionsOf = ({ sessionId, token }: Pairing) => ({
  url: "ws://localhost/api/vr/stream",
  name: "test",
  token,
  storageKey: sessionId,
});
const known = () => earlierPairings().map(({ sessionId }) => sessionId);

beforeEach(() => {
  globalThis.localStorage = new Memory();
});

describe("the sessions that a headset was in before", () => {
  it("keep their tokens when another session's code is used", () => {
    storePairing(A);
    storePairing(B);
    expect(storedPairing()).toEqual(B);
    expect(earlierPairings()).toEqual([{ sessionId: "a", token: "token-a" }]);
    storePairing({ ...B, token: "again" });
    expect(known()).toEqual(["a"]);
  });

  it("keep no token that the server refused", () => {
    storePairing(A);
    forgetPairing(true);
    expect(known()).toEqual([]);
    storePairing(B);
    forgetPairing(false);
    expect(known()).toEqual(["b"]);
  });

  it("are sent one by one, and forgotten when nothing is left or nothing can be", async () => {
    const ends: Record<string, Sent> = { a: "nothing_left", b: "unreachable", c: "unpaired" };
    for (const sessionId of ["a", "b", "c", "now"]) rememberEarlier({ sessionId, token: "t" });
    const sent: string[] = [];
    await sendEarlier("now", optionsOf, async ({ sessionId }) => {
      sent.push(sessionId);
      return ends[sessionId] ?? "unpaired";
    });
    expect(sent).toEqual(["a", "b", "c"]);
    expect(known()).toEqual(["b", "now"]);
  });

  it("are none where the browser holds something else", () => {
    localStorage.setItem("reembody.vr.earlier", '{"no":"list"}');
    expect(earlierPairings()).toEqual([]);
    localStorage.setItem("reembody.vr.earlier", "{");
    expect(earlierPairings()).toEqual([]);
  });
});
