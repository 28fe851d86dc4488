import { describe, expect, it } from "vitest";
import { cacheName, outdated, planFor } from "./plan";

const HERE = "https://study.local";
const plan = (path: string, mode = "cors", method = "GET", origin = HERE) =>
  planFor({ method, mode, url: `${origin}${path}` }, HERE, "/tablet");

describe("what the worker does with a request", () => {
  it("caches the tablet's page and hashed files, and nothing else", () => {
    expect(plan("/tablet", "navigate")).toBe("page");
    expect(plan("/tablet?code=ABC-123", "navigate")).toBe("page");
    expect(plan("/tablet/", "navigate")).toBe("page");
    expect(plan("/assets/tablet-1.js")).toBe("asset");
    expect(plan("/", "navigate")).toBe("leave");
    expect(plan("/tablets", "navigate")).toBe("leave");
  });

  it("never touches the server's API, another site, or a request that changes something", () => {
    expect(plan("/api/tablet/state")).toBe("leave");
    expect(plan("/api/tablet/live")).toBe("leave");
    expect(plan("/api/tablet/submissions", "cors", "POST")).toBe("leave");
    expect(plan("/assets/tablet-1.js", "cors", "GET", "https://elsewhere.example")).toBe("leave");
    expect(plan("/tablet", "navigate", "POST")).toBe("leave");
  });
});

describe("a new build", () => {
  it("deletes all caches but its own and the previous one, and no cache of another application", () => {
    const [first, second, third] = ["1", "2", "3"].map(cacheName) as [string, string, string];
    expect(outdated(["other", first, second, third], third)).toEqual([first]);
    expect(outdated([first, second], second)).toEqual([]);
    expect(outdated([first], first)).toEqual([]);
  });
});
