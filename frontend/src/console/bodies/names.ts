/** What bodies and their licences are called on pages. */
import type { BodyListed } from "@shared/api/bodies";
import type { Key } from "../i18n";

/** The title that the lab has given, else that of the file's author, the name or the file's. */
export const titleOf = (body: BodyListed): string =>
  body.title ?? authorsTitle(body) ?? body.name ?? withoutEnding(body.file_name);

/** Some programs write what they do not know as a word. */
const NO_TITLE = new Set(["", "undefined", "null", "none", "untitled"]);

const authorsTitle = ({ licence }: BodyListed): string | null => {
  const title = licence?.title.trim() ?? "";
  return NO_TITLE.has(title.toLowerCase()) ? null : title;
};

const withoutEnding = (file: string): string => file.replace(/\.[^.]+$/, "") || file;

/** The licences whose names pages write out, and of which they say what they allow. */
const KNOWN = [
  ...(["cc0", "cc_by", "cc_by_sa", "cc_by_nd", "cc_by_nc", "cc_by_nc_sa", "cc_by_nc_nd"] as const),
  ...(["apache", "mit", "vrm_public", "redistribution_prohibited", "other"] as const),
];
export type KnownLicence = (typeof KNOWN)[number];

const SAME: Readonly<Record<string, KnownLicence>> = {
  apache_2_0: "apache",
  apache_license_2_0: "apache",
  mit_license: "mit",
  vrm_public_license_1_0: "vrm_public",
  cc0_1_0: "cc0",
};

/** The licence that a file names in one of its usual spellings, such as CC_BY or CC-BY-4.0. */
export function knownLicence(written: string): KnownLicence | null {
  const plain = written
    .replace(/\(.*$/, "")
    .trim()
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "_")
    .replace(/_+$/, "");
  const unversioned = plain.replace(/^(cc_.*?)_\d(_\d)?$/, "$1");
  const known = KNOWN.find((one) => one === plain || one === unversioned);
  return known ?? SAME[plain] ?? null;
}

const APACHE = /apache\.org\/licenses\/LICENSE-2\.0/i;

/**
 * The licence under which a body may be used. Every VRM names the VRM licence, whose permissions it
 * lists; the licence of its content, where it has one of its own, is the one beside it.
 */
export const licenceWritten = ({ name, other_url }: Licence): string =>
  knownLicence(name) === "vrm_public" && APACHE.test(other_url) ? "Apache-2.0" : name;

type Licence = Pick<NonNullable<BodyListed["licence"]>, "name" | "other_url">;

/** The name of a licence in words, or as the file writes it. */
export function licenceName(written: string, t: (key: Key) => string): string {
  const known = knownLicence(written);
  return known === null ? written : t(`bodies.licence.of.${known}`);
}
