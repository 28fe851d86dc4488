import { describe, expect, it, vi } from "vitest";
import { bytesOf, FileChanged, Unreachable, whyNotSent } from "../api/request";
import { problemText, sentence } from "./Notice";

describe("the message of an error", () => {
  it("begins with a capital, but the name of a file or a column stays as the user wrote it", () => {
    expect(
      [
        "the walks are too fast",
        "gap3.csv, line 4: no",
        "load_kg is not known",
        "walks.csv: no",
      ].map(sentence),
    ).toEqual([
      "The walks are too fast",
      "gap3.csv, line 4: no",
      "load_kg is not known",
      "walks.csv: no",
    ]);
  });

  it("says of each problem of a file where it is, what is wrong and what to do", () => {
    const problem = { path: "obstacles.0.shape", line: 4, message: "No.", remedy: "Use box." };
    expect(problemText(problem, "Line")).toBe("Line 4, obstacles.0.shape: No. Use box.");
    expect(problemText({ message: "No." }, "Line")).toBe("No.");
  });
});

describe("a file that changed on disk after it was chosen", () => {
  const changed = new File(["1"], "walks.csv");
  const unreadable = () => Promise.reject(new DOMException("gone", "NotReadableError"));
  vi.spyOn(changed, "slice").mockReturnValue({ arrayBuffer: unreadable } as unknown as Blob);
  vi.spyOn(changed, "arrayBuffer").mockImplementation(unreadable);

  it("is not taken for a server that does not answer", async () => {
    const sound = new File(["1"], "other.csv");
    expect(await whyNotSent([sound])).toBeInstanceOf(Unreachable);
    expect(await whyNotSent([sound, changed])).toEqual(new FileChanged("walks.csv"));
    await expect(bytesOf(changed)).rejects.toThrow("walks.csv has changed since it was chosen.");
  });
});
