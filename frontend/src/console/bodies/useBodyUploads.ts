/** The queue of uploads, sent one after the other; each stays listed until it is dismissed. */
import { type BodyView, bodies } from "@shared/api/bodies";
import type { Stored } from "@shared/api/upload";
import { useQueryClient } from "@tanstack/react-query";
import { useRef, useState } from "react";
import { bodiesQuery, bodyQuery } from "./queries";

export type UploadPhase =
  | { readonly at: "waiting" }
  | { readonly at: "sending"; readonly share: number }
  | { readonly at: "reading" }
  | { readonly at: "done"; readonly uploaded: Stored<BodyView> }
  | { readonly at: "refused"; readonly error: unknown };

export interface BodyUpload {
  readonly id: number;
  readonly file: File;
  readonly phase: UploadPhase;
}

export interface BodyUploads {
  readonly uploads: readonly BodyUpload[];
  readonly add: (files: readonly File[]) => void;
  readonly retry: (upload: BodyUpload) => void;
  readonly dismiss: (id: number) => void;
}

let counted = 0;

export function useBodyUploads(): BodyUploads {
  const queries = useQueryClient();
  const [uploads, setUploads] = useState<readonly BodyUpload[]>([]);
  const before = useRef<Promise<void>>(Promise.resolve());
  const setPhase = (id: number, phase: UploadPhase) =>
    setUploads((all) => all.map((one) => (one.id === id ? { ...one, phase } : one)));
  const send = ({ id, file }: BodyUpload) => {
    before.current = before.current.then(async () => {
      setPhase(id, { at: "sending", share: 0 });
      try {
        const uploaded = await bodies.upload(file, (share) =>
          setPhase(id, share < 1 ? { at: "sending", share } : { at: "reading" }),
        );
        queries.setQueryData(bodyQuery(uploaded.stored.content_hash).queryKey, uploaded.stored);
        setPhase(id, { at: "done", uploaded });
        await queries.invalidateQueries({ queryKey: bodiesQuery.queryKey, exact: true });
      } catch (error) {
        setPhase(id, { at: "refused", error });
      }
    });
  };
  return {
    uploads,
    add: (files) => {
      const added = files.map((file): BodyUpload => {
        counted += 1;
        return { id: counted, file, phase: { at: "waiting" } };
      });
      setUploads((all) => [...all, ...added]);
      added.forEach(send);
    },
    retry: (upload) => {
      setPhase(upload.id, { at: "waiting" });
      send(upload);
    },
    dismiss: (id) => setUploads((all) => all.filter((one) => one.id !== id)),
  };
}
