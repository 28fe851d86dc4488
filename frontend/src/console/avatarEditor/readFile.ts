/** Read a configuration's file: what is no configuration is refused with its place and remedy. */
import { ApiError, type Problem, textOf } from "@shared/api/request";
import { bytes } from "@shared/format";
import type { useTexts } from "../i18n";
import { avatars } from "./api";
import type { ReadFile } from "./ImportDialog";

/** What the server accepts; a configuration of the whole body has a twentieth of it. */
const MOST_BYTES = 262_144;
const MOST_PROBLEMS = 3;

/** The configuration in a file. Throws an ApiError with its problems, or what the server refuses. */
export async function readAvatarFile(
  file: File,
  { t, language }: ReturnType<typeof useTexts>,
): Promise<ReadFile> {
  const refused = (remedy: string, sentences: readonly string[] = []) =>
    new ApiError(422, {
      code: "invalid_config",
      message: t("avatars.import.refused", { name: shortened(file.name) }),
      remedy,
      details: sentences.map((message) => ({ message })),
    });
  if (file.size > MOST_BYTES) {
    const sizes = { size: bytes(file.size, language), most: bytes(MOST_BYTES, language) };
    throw refused(t("avatars.import.tooLarge", sizes));
  }
  const text = await textOf(file);
  const { ok, configuration, problems } = await avatars.check(text);
  if (ok && configuration) return { name: shortened(file.name), configuration };
  // Of a file in one line, the line says nothing.
  const told = problems
    .slice(0, MOST_PROBLEMS)
    .map((one) => sentence(text.trim().includes("\n") ? one : { ...one, line: null }, t));
  const more = problems.length - told.length;
  if (more > 0) told.push(t("avatars.import.more", { count: more }));
  throw refused("", told);
}

function sentence({ line, path, message, remedy }: Problem, t: ReturnType<typeof useTexts>["t"]) {
  const place = [line ? t("avatars.import.line", { line }) : "", path ?? ""];
  const where = place.filter((one) => one !== "").join(", ");
  return `${where}${where === "" ? "" : ": "}${message} ${remedy ?? ""}`.trim();
}

/** A name as a title can hold it, without characters that turn the direction of the text. */
const shortened = (name: string): string => {
  const letters = [...name.replace(/[\u202a-\u202e\u2066-\u2069]/g, "")];
  const ends = () => `${letters.slice(0, 40).join("")}…${letters.slice(-15).join("")}`;
  return letters.length > 60 ? ends() : letters.join("");
};
