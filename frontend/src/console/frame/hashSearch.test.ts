import { describe, expect, it } from "vitest";
import { withSearchInFront } from "./hashSearch";

const at = (rest: string) => `http://127.0.0.1:8321/${rest}`;

describe("an address with its search behind the route", () => {
  it("becomes the one that the router reads, in place of the search of an earlier page", () => {
    expect(withSearchInFront(at("#/studies/a/dashboard?kind=simulated&rows=all"))).toBe(
      at("?kind=simulated&rows=all#/studies/a/dashboard"),
    );
    expect(withSearchInFront(at("?kind=test#/studies/a/statistics?kind=people"))).toBe(
      at("?kind=people#/studies/a/statistics"),
    );
  });

  it("is left as it is where there is none, and in a replay", () => {
    for (const rest of [
      "",
      "#/studies/a/dashboard",
      "?kind=test#/studies/a/dashboard",
      "#/sessions/a/replay?phase=2&t=1.5",
    ]) {
      expect(withSearchInFront(at(rest))).toBeNull();
    }
  });
});
