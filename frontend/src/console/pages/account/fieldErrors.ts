/** At which field of a form about an account the server's refusal belongs. */
import { type ApiError, isApiError } from "@shared/api/errors";

export interface FieldErrors {
  readonly username: string | null;
  readonly password: string | null;
  /** What belongs to no field. */
  readonly other: unknown;
}

const NONE: FieldErrors = { username: null, password: null, other: null };

/** The server repeats a name that it refuses, and never a password. */
export function fieldErrors(error: unknown): FieldErrors {
  if (error === null) return NONE;
  if (!isApiError(error, "invalid_input")) return { ...NONE, other: error };
  const said = sentence(error);
  return typeof error.value === "string"
    ? { ...NONE, username: said }
    : { ...NONE, password: said };
}

const sentence = ({ message, valid, remedy }: ApiError): string => {
  const parts = [message, typeof valid === "string" ? `valid: ${valid}` : "", remedy ?? ""];
  return parts
    .filter((part) => part !== "")
    .map((part) => part.charAt(0).toUpperCase() + part.slice(1).replace(/\.$/, ""))
    .join(". ")
    .concat(".");
};
