/**
 * The configuration that is being edited. The server makes every edit, so that the page, the
 * command and scripts do the same; the page keeps the states in between.
 */
import { isUnauthorised } from "@shared/api/request";
import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useRef, useState } from "react";
import { checkSignIn } from "../account";
import {
  type AvatarEdited,
  type AvatarVersionDetail,
  avatars,
  type JointView,
  type Made,
  type Operation,
} from "./api";
import type { AvatarFile } from "./axes";
import { begun, type History, reached, redone, since, undone } from "./history";

/** One state of the work, as the server answered it. */
export interface WorkState {
  readonly configuration: AvatarFile;
  readonly contentHash: string;
  readonly joints: Readonly<Record<string, JointView>>;
  /** What led here, in words. */
  readonly label: string;
  /** How its values were found; by hand where nothing is said. */
  readonly made?: Made | undefined;
  /** The values that led here changed. */
  readonly changed: AvatarEdited["changed"];
}

export type EditProblem = AvatarEdited["problems"][number];

export interface Work extends WorkState {
  readonly canUndo: boolean;
  readonly canRedo: boolean;
  /** What undo would take back, and redo would do again. */
  readonly undoLabel: string;
  readonly redoLabel: string;
  readonly isBusy: boolean;
  readonly problems: readonly EditProblem[];
  readonly error: unknown;
  readonly undo: () => void;
  readonly redo: () => void;
  /** Apply operations to the newest state; false if one of them cannot be made. */
  readonly edit: (operations: readonly Operation[], label: string, made?: Made) => Promise<boolean>;
  /** How everything that was done since a saved content was made: by hand if in several ways. */
  readonly madeSince: (savedHash: string) => Made;
  /** Go to a saved version, and make the edit there; both can be undone. */
  readonly editFrom: (
    version: AvatarVersionDetail,
    operations: readonly Operation[],
    label: string,
  ) => Promise<boolean>;
  /** Show why something else could not be done. */
  readonly fail: (failure: unknown) => void;
  readonly dismiss: () => void;
}

export const stateOf = (edited: AvatarEdited, label: string): WorkState => ({
  configuration: edited.configuration,
  contentHash: edited.content_hash ?? "",
  joints: edited.joints,
  label,
  changed: edited.changed,
});

export const stateOfVersion = (version: AvatarVersionDetail, label: string): WorkState => ({
  configuration: version.configuration,
  contentHash: version.content_hash,
  joints: version.joints,
  label,
  changed: [],
});

export function useWork(first: WorkState): Work {
  const queries = useQueryClient();
  const [history, setHistory] = useState(() => begun(first));
  const newest = useRef(history);
  const queue = useRef<Promise<unknown>>(Promise.resolve());
  const [waiting, setWaiting] = useState(0);
  const [problems, setProblems] = useState<readonly EditProblem[]>([]);
  const [error, setError] = useState<unknown>(null);
  const put = useCallback((next: History<WorkState>) => {
    newest.current = next;
    setHistory(next);
  }, []);
  const dismiss = useCallback(() => {
    setProblems([]);
    setError(null);
  }, []);
  const fail = useCallback(
    (failure: unknown) => {
      setProblems([]);
      setError(failure);
      // Edits are no queries, which the page watches: without this it would not ask to sign in.
      if (isUnauthorised(failure)) void checkSignIn(queries);
    },
    [queries],
  );
  const apply = useCallback(
    (
      from: WorkState | null,
      operations: readonly Operation[],
      label: string,
      made?: Made,
    ): Promise<boolean> => {
      // One after the other: an edit starts from what the one before it has made.
      const done = queue.current.then(async () => {
        try {
          const start = from === null ? newest.current : reached(newest.current, from);
          const { configuration, contentHash } = start.now;
          const edited = await avatars.edit(configuration, operations);
          setError(null);
          setProblems(edited.problems);
          if (edited.problems.length > 0) return false;
          const isSame = edited.content_hash === contentHash;
          if (!isSame || from !== null) {
            put(isSame ? start : reached(start, { ...stateOf(edited, label), made }));
          }
          return true;
        } catch (failure) {
          fail(failure);
          return false;
        }
      });
      queue.current = done;
      setWaiting((count) => count + 1);
      void done.finally(() => setWaiting((count) => count - 1));
      return done;
    },
    [put, fail],
  );
  const edit = useCallback(
    (operations: readonly Operation[], label: string, made?: Made) =>
      apply(null, operations, label, made),
    [apply],
  );
  const move = (to: (from: History<WorkState>) => History<WorkState>) => {
    // After the edits that are under way: otherwise they would land on top of what was undone.
    queue.current = queue.current.then(() => put(to(newest.current)));
    dismiss();
  };
  return {
    ...history.now,
    canUndo: history.past.length > 0,
    canRedo: history.future.length > 0,
    undoLabel: history.now.label,
    redoLabel: history.future[0]?.label ?? "",
    isBusy: waiting > 0,
    problems,
    error,
    undo: () => move(undone),
    redo: () => move(redone),
    edit,
    editFrom: (version, operations, label) =>
      apply(stateOfVersion(version, label), operations, label),
    madeSince: (savedHash) => {
      const steps = since(history, ({ contentHash }) => contentHash === savedHash);
      const ways = new Set(steps.map(({ made = "by_hand" }) => made));
      const [only = "by_hand"] = ways;
      return ways.size === 1 ? only : "by_hand";
    },
    fail,
    dismiss,
  };
}
