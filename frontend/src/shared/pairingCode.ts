/** Pairing codes: six letters or digits in two groups of three (`4FQ-7KP`). */

export const CODE_LENGTH = 6;

/** The letters and digits that were typed, in capitals, at most as many as a code has. */
export function codeCharacters(typed: string): string {
  return typed
    .toUpperCase()
    .replace(/[^A-Z0-9]/g, "")
    .slice(0, CODE_LENGTH);
}

/** A code as it is shown and sent: with its dash as soon as the first group is complete. */
export function writtenCode(characters: string): string {
  return characters.length <= 3 ? characters : `${characters.slice(0, 3)}-${characters.slice(3)}`;
}

/** The code in a QR link's address, and the address without it. */
export function codeFromAddress(address: URL): { code: string | null; rest: string } {
  const characters = codeCharacters(address.searchParams.get("code") ?? "");
  const rest = new URL(address);
  rest.searchParams.delete("code");
  return {
    code: characters.length === CODE_LENGTH ? writtenCode(characters) : null,
    rest: `${rest.pathname}${rest.search}${rest.hash}`,
  };
}
