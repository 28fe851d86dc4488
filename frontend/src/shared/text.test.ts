import { describe, expect, it } from "vitest";
import { inLanguage, isText, paragraphs, withoutMarks } from "./text";

describe("texts", () => {
  it("fall back to English and then to any language", () => {
    expect(inLanguage({ en: "hand", de: "Hand" }, "de")).toBe("Hand");
    expect(inLanguage({ en: "hand" }, "de")).toBe("hand");
    expect(inLanguage({ fr: "main" }, "de")).toBe("main");
    expect(inLanguage(null, "de")).toBe("");
  });

  it("are split into paragraphs, points and headings", () => {
    expect(paragraphs("# Rights\nYou may stop.\n\nPlease:\n- ask\n- rest\n  a little")).toEqual([
      { kind: "heading", text: "Rights" },
      { kind: "prose", text: "You may stop." },
      { kind: "prose", text: "Please:" },
      { kind: "points", points: ["ask", "rest a little"] },
    ]);
  });

  it("show a picture if its name is alone on a line", () => {
    expect(paragraphs("Like this:\n\n![t_pose]\n\nSay ![t_pose] aloud.")).toEqual([
      { kind: "prose", text: "Like this:" },
      { kind: "picture", name: "t_pose" },
      { kind: "prose", text: "Say ![t_pose] aloud." },
    ]);
  });

  it("lose their marks in one line", () => {
    expect(withoutMarks("# Rights\nYou may stop.\n\n![t_pose]\n\n- ask\n- rest")).toBe(
      "Rights · You may stop. · ask; rest",
    );
  });

  it("keep markup as plain text", () => {
    expect(paragraphs("<script>alert(1)</script>")).toEqual([
      { kind: "prose", text: "<script>alert(1)</script>" },
    ]);
  });
});

describe("what was read from a file", () => {
  it("is text unless bytes were replaced or are zeros, as in a picture", () => {
    expect(isText("title: Größe\n")).toBe(true);
    expect(isText("\uFFFDPNG\r\n")).toBe(false);
    expect(isText("a\u0000b")).toBe(false);
  });
});
