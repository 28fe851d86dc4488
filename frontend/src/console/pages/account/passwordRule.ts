/** The server's rule for passwords, checked during typing; the server's decision is final. */

export const MIN_LENGTH = 12;
export const MAX_LENGTH = 200;
export const MIN_DIFFERENT = 5;
const PROGRAM = "reembody";

export interface PasswordChecks {
  readonly length: boolean;
  readonly different: boolean;
  readonly name: boolean;
  readonly same: boolean;
}

export function checkPassword(
  password: string,
  repeated: string,
  username: string,
): PasswordChecks {
  const small = password.toLowerCase();
  const mostly = (name: string): boolean =>
    small.includes(name.toLowerCase()) && password.length < MIN_LENGTH + name.length;
  return {
    length: [...password].length >= MIN_LENGTH,
    different: new Set(small).size >= MIN_DIFFERENT,
    name: password !== "" && !mostly(PROGRAM) && !(username !== "" && mostly(username)),
    same: password !== "" && password === repeated,
  };
}

export const isGood = (checks: PasswordChecks): boolean => Object.values(checks).every(Boolean);
