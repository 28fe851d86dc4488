import { readdirSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { describe, expect, it } from "vitest";

const CONSOLE = resolve(import.meta.dirname, "..");
const files = readdirSync(CONSOLE, { recursive: true, encoding: "utf8" })
  .filter((name) => name.endsWith(".tsx"))
  .map((name) => ({ name, text: readFileSync(join(CONSOLE, name), "utf8") }));

/** The functions of a file, each with its name. */
const functions = (text: string): readonly string[] =>
  text.split(/^(?:export )?function /m).slice(1);

describe("a dialog", () => {
  it("forgets a failure when it is closed: its content is remounted, or it resets", () => {
    const leaking = files.flatMap(({ name, text }) =>
      functions(text)
        .filter((body) => body.includes("<Modal") && body.includes("useMutation("))
        .filter((body) => !body.includes(".reset()"))
        .map((body) => `${name}: ${body.slice(0, body.indexOf("("))}`),
    );
    expect(leaking).toEqual([]);
  });

  it("never shows a failure from elsewhere: one component shows a shared command's error", () => {
    const others = files.filter(({ text }) => /\b(?:live|direct)\.error\b/.test(text));
    expect(others.map(({ name }) => name)).toEqual([
      join("cockpit", "session", "CommandFailure.tsx"),
    ]);
  });
});
