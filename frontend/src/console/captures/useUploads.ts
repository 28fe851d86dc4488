/**
 * The queue of uploads, sent one after the other; rejected ones stay listed until they are
 * dismissed.
 */
import { type CaptureFiles, type Uploaded, uploadCapture } from "@shared/api/captures";
import { useQueryClient } from "@tanstack/react-query";
import { useReducer, useRef } from "react";
import { capturesQuery } from "./queries";

export type Phase =
  | { readonly at: "waiting" }
  | { readonly at: "sending"; readonly share: number }
  | { readonly at: "reading" }
  | { readonly at: "done"; readonly uploaded: Uploaded }
  | { readonly at: "refused"; readonly error: unknown };

export interface Upload {
  readonly id: number;
  readonly files: CaptureFiles;
  readonly phase: Phase;
}

interface State {
  readonly uploads: readonly Upload[];
  readonly lonely: readonly File[];
}

type Change =
  | { readonly do: "add"; readonly uploads: readonly Upload[]; readonly lonely: readonly File[] }
  | { readonly do: "phase"; readonly id: number; readonly phase: Phase }
  | { readonly do: "dismiss"; readonly id: number }
  | { readonly do: "drop"; readonly file: File };

function changed(state: State, change: Change): State {
  switch (change.do) {
    case "add":
      return { uploads: [...state.uploads, ...change.uploads], lonely: change.lonely };
    case "phase":
      return {
        ...state,
        uploads: state.uploads.map((one) =>
          one.id === change.id ? { ...one, phase: change.phase } : one,
        ),
      };
    case "dismiss":
      return { ...state, uploads: state.uploads.filter(({ id }) => id !== change.id) };
    case "drop":
      return { ...state, lonely: state.lonely.filter((file) => file !== change.file) };
  }
}

export interface Uploads extends State {
  readonly add: (files: readonly File[]) => void;
  readonly retry: (upload: Upload) => void;
  readonly dismiss: (id: number) => void;
  readonly drop: (file: File) => void;
}

let counted = 0;

export function useUploads(): Uploads {
  const queries = useQueryClient();
  const [state, change] = useReducer(changed, { uploads: [], lonely: [] });
  const before = useRef<Promise<void>>(Promise.resolve());
  const send = ({ id, files }: Upload) => {
    before.current = before.current.then(async () => {
      const setPhase = (phase: Phase) => change({ do: "phase", id, phase });
      setPhase({ at: "sending", share: 0 });
      try {
        const uploaded = await uploadCapture(files, (share) =>
          setPhase(share < 1 ? { at: "sending", share } : { at: "reading" }),
        );
        setPhase({ at: "done", uploaded });
        await queries.invalidateQueries({ queryKey: capturesQuery.queryKey, exact: true });
      } catch (error) {
        setPhase({ at: "refused", error });
      }
    });
  };
  return {
    ...state,
    add: (files) => {
      const { ready, lonely } = pairFiles([...state.lonely, ...files]);
      const uploads = ready.map((pair): Upload => {
        counted += 1;
        return { id: counted, files: pair, phase: { at: "waiting" } };
      });
      change({ do: "add", uploads, lonely });
      uploads.forEach(send);
    },
    retry: (upload) => {
      change({ do: "phase", id: upload.id, phase: { at: "waiting" } });
      send(upload);
    },
    dismiss: (id) => change({ do: "dismiss", id }),
    drop: (file) => change({ do: "drop", file }),
  };
}

/** What pairing needs of a file: its name. */
interface Named {
  readonly name: string;
}

interface Pairs<File extends Named> {
  /** Files that can be sent. */
  readonly ready: readonly { readonly file: File; readonly companion: File | null }[];
  /** An AMC without its ASF, or vice versa. */
  readonly lonely: readonly File[];
}

const ending = (name: string): string => /\.([^.]+)$/.exec(name)?.[1]?.toLowerCase() ?? "";
const isAmc = ({ name }: Named): boolean => ending(name) === "amc";
const isAsf = ({ name }: Named): boolean => ending(name) === "asf";

/** The file type that a lonely file is missing. */
export const missingCompanion = (file: Named): ".asf" | ".amc" => (isAmc(file) ? ".asf" : ".amc");

/**
 * Pair files by name. One ASF serves every AMC of its person: CMU's 02.asf goes with 02_01.amc and
 * 02_06.amc.
 */
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

/** The skeleton whose name the file's name starts with, or the only one, whatever it is called. */
function skeletonFor<File extends Named>(file: File, skeletons: readonly File[]): File | null {
  if (skeletons.length === 1) return skeletons[0] ?? null;
  const alike = skeletons.filter(({ name }) =>
    file.name.toLowerCase().startsWith(name.replace(/\.[^.]+$/, "").toLowerCase()),
  );
  return alike.toSorted((a, b) => b.name.length - a.name.length)[0] ?? null;
}
