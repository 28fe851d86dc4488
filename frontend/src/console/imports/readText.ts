/** Read the file from which answers are imported as text. */

export interface OpenedFile {
  readonly name: string;
  readonly text: string;
}

/**
 * The text of a file of unknown encoding: UTF-8 if valid, otherwise by its byte order mark,
 * otherwise Windows-1252.
 */
export function decoded(bytes: ArrayBuffer): string {
  const [first, second] = new Uint8Array(bytes.slice(0, 2));
  if (first === 0xff && second === 0xfe) return new TextDecoder("utf-16le").decode(bytes);
  if (first === 0xfe && second === 0xff) return new TextDecoder("utf-16be").decode(bytes);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/** Whether this can be the text of a table: a picture, a PDF or a workbook is not. */
export function isText(text: string): boolean {
  if (text.startsWith("%PDF-") || text.startsWith("PK\u0003\u0004")) return false;
  for (const character of text) {
    const code = character.charCodeAt(0);
    if (code < 0x20 && !"\t\n\v\f\r".includes(character)) return false;
  }
  return true;
}
