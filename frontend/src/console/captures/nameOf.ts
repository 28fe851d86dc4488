/** `account:admin` is admin. */
export const nameOf = (actor: string): string => actor.replace("account:", "");
