import { expect, test } from "vitest";
import { numbersIn } from "./numbers";

test("numbers are read however they are separated, and each counts once", () => {
  expect(numbersIn("12, 6;9 6")).toEqual([6, 9, 12]);
});

test("what is no list of numbers is none", () => {
  for (const text of ["", " , ", "6, many", "-3", "1.5", "12345", "1, 2", "1001"])
    expect(numbersIn(text)).toBeNull();
});
