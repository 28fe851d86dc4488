import { expect, test } from "vitest";
import { largerThan, lostIn, numbersIn } from "./numbers";

test("numbers are read however they are separated, and each counts once", () => {
  expect(numbersIn("12, 6;9 6")).toEqual([6, 9, 12]);
});

test("what is no list of numbers is none", () => {
  for (const text of ["", " , ", "6, many", "-3", "1.5", "12345", "1, 2", "1001"])
    expect(numbersIn(text)).toBeNull();
});

test("larger numbers to try end at the most that can be simulated", () => {
  expect(largerThan(24)).toEqual([36, 48]);
  expect(largerThan(600)).toEqual([900]);
  expect(largerThan(1000)).toEqual([]);
});

test("those who start and are not in the test are told in per cent", () => {
  expect(lostIn([{ n: 24, mean_in_test: 20 }])).toBe(17);
  expect(lostIn([])).toBe(0);
});
