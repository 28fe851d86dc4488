/** Addresses of help pages, and which help page belongs to a page of the console. */

/** The most relevant help page for each page of the console; the first match counts. */
export const HELPS: readonly (readonly [address: RegExp, key: string])[] = [
  [/^\/sessions\//, "operators-tour"],
  [/^\/studies\/[^/]+\/participants/, "participants-rights"],
  [/^\/studies\/[^/]+\/preregistration/, "preregistration"],
  [/^\/studies\/[^/]+\/pilot/, "pilot"],
  [/^\/studies\/[^/]+\/statistics/, "statistics"],
  [/^\/studies\/[^/]+\/(export|dashboard)/, "data-dictionary"],
  [/^\/(new|studies\/[^/]+\/(edit|protocol|versions))/, "study-configs"],
  [/^\/instruments/, "study-configs"],
  [/^\/captures/, "captures"],
  [/^\/walking/, "walking"],
  [/^\/equipment/, "headsets"],
  [/^\/network/, "lab-network"],
  [/^\/storage/, "backups"],
  [/^\/people/, "people-and-roles"],
];
const ELSE = "operators-tour";

export const helpAddress = (key: string, heading?: string): string =>
  heading === undefined ? `/help/${key}` : `/help/${key}/${heading}`;

/** The address of the help about the page at `address`. */
export const helpFor = (address: string): string =>
  helpAddress(HELPS.find(([pattern]) => pattern.test(address))?.[1] ?? ELSE);
