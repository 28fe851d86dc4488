import { uuid } from "@shared/uuid";
import { expect, it } from "vitest";
import { takeLock } from "./open";

it("is held by one page at a time, and passed on", async () => {
  const name = uuid();
  const letGo = await takeLock(name, 1);
  expect(letGo).not.toBe(null);
  expect(await takeLock(name, 0.02)).toBe(null);
  const next = takeLock(name, 5);
  letGo?.();
  expect(await next).not.toBe(null);
});

it("is missing in a browser without locks", async () => {
  expect(await takeLock("any", 1, undefined)).not.toBe(null);
});
