/** Break a text into lines that fit a width. */

/** The width of a text in dmm, at a size in dmm. */
export type Measure = (text: string, sizeDmm: number, isBold: boolean) => number;

export interface Font {
  readonly sizeDmm: number;
  readonly isBold: boolean;
}

/** The lines of a text; a word wider than a line is broken where it has to be. */
export function wrap(
  text: string,
  widthDmm: number,
  { sizeDmm, isBold }: Font,
  measure: Measure,
): readonly string[] {
  const lines: string[] = [];
  let line = "";
  const fits = (candidate: string) => measure(candidate, sizeDmm, isBold) <= widthDmm;
  for (const word of text.split(/\s+/).filter((one) => one !== "")) {
    const longer = line === "" ? word : `${line} ${word}`;
    if (fits(longer)) {
      line = longer;
      continue;
    }
    if (line !== "") lines.push(line);
    line = word;
    while (!fits(line) && line.length > 1) {
      const head = longestHead(line, fits);
      lines.push(head);
      line = line.slice(head.replace(/-$/, "").length);
    }
  }
  if (line !== "") lines.push(line);
  return lines;
}

/** The longest beginning of a word that fits, with the hyphen that it then needs. */
function longestHead(word: string, fits: (candidate: string) => boolean): string {
  let length = word.length - 1;
  while (length > 1 && !fits(`${word.slice(0, length)}-`)) length -= 1;
  const head = word.slice(0, length);
  return head.endsWith("-") ? head : `${head}-`;
}
