import { afterEach, expect, it, vi } from "vitest";
import { uuid } from "./uuid";

const VERSION_4 = /^[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$/;

afterEach(() => vi.unstubAllGlobals());

it("is a version 4 UUID, also on a page without a secure context", () => {
  expect(uuid()).toMatch(VERSION_4);
  const { getRandomValues } = crypto;
  vi.stubGlobal("crypto", { getRandomValues: getRandomValues.bind(crypto) });
  expect(uuid()).toMatch(VERSION_4);
  expect(uuid()).not.toBe(uuid());
});
