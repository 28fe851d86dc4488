/** The joint map of a capture's skeleton, as stored on the server and as edited here. */
import { type Capture, captures, type JointMapView } from "@shared/api/captures";
import { isApiError } from "@shared/api/request";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { type BodyMap, begin, type MapEdit, sameMap } from "./jointMapEdit";
import { capturesQuery, jointMapQuery } from "./queries";

/** `base` is the map on which the edit is based, `version` its number on the server. */
interface Draft {
  readonly edit: MapEdit;
  readonly base: BodyMap;
  readonly version: number;
}

export interface JointMapDraft {
  /** Undefined while it is loading, or if the capture has no skeleton. */
  readonly view: JointMapView | undefined;
  readonly loadError: unknown;
  readonly edit: MapEdit;
  readonly unsaved: boolean;
  readonly change: (step: (edit: MapEdit) => MapEdit) => void;
  readonly save: () => void;
  readonly saving: boolean;
  readonly saved: boolean;
  readonly error: unknown;
  /** Somebody else has saved since this edit was started. */
  readonly stale: boolean;
  readonly takeTheirs: () => void;
  readonly saveMine: () => void;
}

const NOTHING: BodyMap = {};

export function useJointMap(capture: Capture): JointMapDraft {
  const queries = useQueryClient();
  const query = useQuery({ ...jointMapQuery(capture.id), enabled: capture.has_skeleton });
  const [draft, setDraft] = useState<Draft | null>(null);
  const view = query.data;
  const unsaved = draft !== null && !sameMap(draft.edit.present, draft.base);
  // Without unsaved changes, the version that somebody else saved is shown.
  const current = draft !== null && (unsaved || draft.version === view?.version) ? draft : null;
  const edit = current?.edit ?? begin(view?.joint_map ?? NOTHING);
  const save = useMutation({
    mutationFn: ({ map, version }: { readonly map: BodyMap; readonly version: number }) =>
      // A map equal to the proposal follows it, so that a better proposal of a later version is
      // used.
      view !== undefined && sameMap(map, view.proposal)
        ? captures.resetJointMap(capture.id, version)
        : captures.saveJointMap(capture.id, version, map),
    onSuccess: (now) => {
      queries.setQueryData(jointMapQuery(capture.id).queryKey, now);
      setDraft({ edit, base: now.joint_map, version: now.version });
      void queries.invalidateQueries({ queryKey: capturesQuery.queryKey, exact: true });
    },
    onError: (error) => {
      if (isApiError(error, "stale")) void query.refetch();
    },
  });
  return {
    view,
    loadError: query.error,
    edit,
    unsaved,
    change: (step) => {
      if (view === undefined) return;
      if (!save.isIdle) save.reset();
      const { base, version } = current ?? { base: view.joint_map, version: view.version };
      setDraft({ edit: step(edit), base, version });
    },
    save: () => current !== null && save.mutate({ map: edit.present, version: current.version }),
    saving: save.isPending,
    saved: save.isSuccess && !unsaved,
    error: save.error,
    stale: isApiError(save.error, "stale"),
    takeTheirs: () => {
      save.reset();
      setDraft(null);
    },
    saveMine: () => view !== undefined && save.mutate({ map: edit.present, version: view.version }),
  };
}
