/** A text in several languages, as studies and instruments contain it. */
export type Text = Readonly<Record<string, string>>;

/** The text in `language`, otherwise in English, otherwise in any language it has. */
export function inLanguage(text: Text | string | null | undefined, language: string): string {
  if (text === null || text === undefined) return "";
  if (typeof text === "string") return text;
  return text[language] ?? text.en ?? Object.values(text)[0] ?? "";
}

/** Whether what was read from a file is text: bytes that are none were replaced, or are zeros. */
export const isText = (read: string): boolean =>
  !read.includes("\u0000") && !read.includes("\uFFFD");

/**
 * The parts of a longer text: blank lines separate paragraphs, lines starting with `- ` are points,
 * and `![t_pose]` alone is a picture by its name.
 */
export type Paragraph =
  | { readonly kind: "prose"; readonly text: string }
  | { readonly kind: "heading"; readonly text: string }
  | { readonly kind: "picture"; readonly name: string }
  | { readonly kind: "points"; readonly points: readonly string[] };

const POINT = /^\s*[-*]\s+/;
const HEADING = /^#+\s+/;
const PICTURE = /^!\[([a-z_]+)\]$/;

/** Split a text into paragraphs, points and headings; nothing in it is ever interpreted as HTML. */
export function paragraphs(text: string): readonly Paragraph[] {
  return text
    .split(/\n\s*\n/)
    .map((part) => part.trim())
    .filter((part) => part !== "")
    .flatMap(paragraph);
}

function paragraph(part: string): readonly Paragraph[] {
  const lines = part.split("\n");
  const first = lines[0] ?? "";
  if (HEADING.test(first)) {
    const rest = lines.slice(1).join("\n").trim();
    const heading: Paragraph = { kind: "heading", text: first.replace(HEADING, "") };
    return rest === "" ? [heading] : [heading, ...paragraph(rest)];
  }
  const picture = PICTURE.exec(part);
  if (picture !== null) return [{ kind: "picture", name: picture[1] ?? "" }];
  const start = lines.findIndex((line) => POINT.test(line));
  if (start === -1) return [{ kind: "prose", text: lines.map((line) => line.trim()).join(" ") }];
  const points: Paragraph = { kind: "points", points: joinPoints(lines.slice(start)) };
  const before = lines.slice(0, start).join(" ").trim();
  return before === "" ? [points] : [{ kind: "prose", text: before }, points];
}

/** Join a line that does not start a point with the line before it. */
function joinPoints(lines: readonly string[]): readonly string[] {
  const points: string[] = [];
  for (const line of lines) {
    if (POINT.test(line)) points.push(line.replace(POINT, "").trim());
    else points.push(`${points.pop() ?? ""} ${line.trim()}`.trim());
  }
  return points;
}

/** The words of a longer text in one line, without the marks of headings, points and pictures. */
export const withoutMarks = (text: string): string =>
  paragraphs(text)
    .flatMap((part) => {
      if (part.kind === "picture") return [];
      return part.kind === "points" ? [part.points.join("; ")] : [part.text];
    })
    .join(" · ");
