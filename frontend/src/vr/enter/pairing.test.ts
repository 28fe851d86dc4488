import { describe, expect, it } from "vitest";
import { storedPairing } from "./pairing";

const holding = (text: string | null) => ({ getItem: () => text });

describe("the pairing that a browser keeps", () => {
  it("has the code that it came from, so that its link can be opened again", () => {
    const pairing = { sessionId: "one", token: "secret", code: "4FQ-7KP" };
    expect(storedPairing(holding(JSON.stringify(pairing)))).toEqual(pairing);
  });

  it("may be of an earlier version, which kept no code", () => {
    const pairing = { sessionId: "one", token: "secret" };
    expect(storedPairing(holding(JSON.stringify(pairing)))).toEqual(pairing);
  });

  it.each([null, "", "null", "{", '{"token":"secret"}', '{"sessionId":7,"token":"secret"}'])(
    "is none where the browser holds %s",
    (text) => {
      expect(storedPairing(holding(text))).toBeNull();
    },
  );
});
