/** Which of the chosen files belong together: an AMC moves the skeleton that its ASF describes. */

interface Named {
  readonly name: string;
}

export interface Pairs<File extends Named> {
  /** Ready to be sent. */
  readonly ready: readonly { readonly file: File; readonly companion: File | null }[];
  /** An AMC without its ASF, or the other way round. */
  readonly lonely: readonly File[];
}

const ending = (name: string): string => /\.([^.]+)$/.exec(name)?.[1]?.toLowerCase() ?? "";
const isAmc = ({ name }: Named): boolean => ending(name) === "amc";
const isAsf = ({ name }: Named): boolean => ending(name) === "asf";

/** What is missing beside a lonely file. */
export const missingBeside = (file: Named): ".asf" | ".amc" => (isAmc(file) ? ".asf" : ".amc");

/** One ASF serves every AMC of its person: CMU's 02.asf goes with 02_01.amc and 02_06.amc. */
export function pairFiles<File extends Named>(files: readonly File[]): Pairs<File> {
  const skeletons = files.filter(isAsf);
  const movements = files.filter(isAmc);
  const chosen = movements.map((file) => ({ file, companion: skeletonFor(file, skeletons) }));
  const used = new Set(chosen.map(({ companion }) => companion));
  return {
    ready: [
      ...files
        .filter((file) => !isAsf(file) && !isAmc(file))
        .map((file) => ({ file, companion: null })),
      ...chosen.filter(({ companion }) => companion !== null),
    ],
    lonely: [
      ...chosen.filter(({ companion }) => companion === null).map(({ file }) => file),
      ...skeletons.filter((file) => !used.has(file)),
    ],
  };
}

/** The one whose name begins alike; the only one there is, whatever it is called. */
function skeletonFor<File extends Named>(file: File, skeletons: readonly File[]): File | null {
  if (skeletons.length === 1) return skeletons[0] ?? null;
  const alike = skeletons.filter(({ name }) =>
    file.name.toLowerCase().startsWith(name.replace(/\.[^.]+$/, "").toLowerCase()),
  );
  return alike.toSorted((a, b) => b.name.length - a.name.length)[0] ?? null;
}
