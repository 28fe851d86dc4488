/** One form on this tablet: its draft, and its delivery until the server has stored it. */
import { tablet } from "@shared/api/endpoints";
import type { ApiError } from "@shared/api/request";
import type {
  Administration,
  Answer,
  FormStored,
  Submission,
  TabletState,
} from "@shared/api/types";
import { deliver } from "@shared/forms/deliver";
import type { FormDraft } from "@shared/forms/draft";
import type { Filling } from "@shared/forms/filling";
import { type StoredForm, submissionOf } from "@shared/forms/storedForms";
import { useCallback, useEffect, useRef, useState } from "react";
import { earlyForm, forgetEarlyForm } from "../early/earlyForm";
import { type Signing, UNSIGNED } from "../screens/consentToSend";
import { drafts } from "./drafts";

export type FormPhase =
  | { readonly name: "opening" }
  | {
      readonly name: "filling";
      readonly form: StoredForm;
      /** How far it was filled in before the application was there. */
      readonly begun?: Filling;
      readonly refused: ApiError | null;
    }
  | { readonly name: "sending"; readonly offline: boolean }
  | { readonly name: "held"; readonly error: ApiError }
  | { readonly name: "done" };

const RETRY_MS = 3000;

interface StoredFormHandle {
  readonly phase: FormPhase;
  readonly storeDraft: (draft: FormDraft) => void;
  /** Try once more to send a held form to the server. */
  readonly retry: () => void;
  readonly send: (answers: Readonly<Record<string, Answer>>, draft: FormDraft) => void;
}

/**
 * Keep a form's draft on disk and deliver it.
 *
 * `onStored` gets the screen that the server answers a stored form with; `onSettled` is called when
 * the screen may have changed without such an answer: superseded, withdrawn, unpaired, or sent by
 * the sweep.
 */
export function useStoredForm(
  sessionId: string,
  administration: Administration,
  language: string,
  onStored: (next: TabletState) => void,
  onSettled: () => void,
): StoredFormHandle {
  const [early] = useState(() => earlyForm(sessionId, administration.key));
  const [phase, setPhase] = useState<FormPhase>(() =>
    early === null
      ? { name: "opening" }
      : { name: "filling", form: early.form, begun: early.filling, refused: null },
  );
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  const form = useRef<StoredForm | null>(early?.form ?? null);
  const stored = useRef(onStored);
  const settled = useRef(onSettled);
  useEffect(() => {
    stored.current = onStored;
    settled.current = onSettled;
  });

  const attempt = useCallback(async (id: string, submission: Submission) => {
    clearTimeout(timer.current);
    let next: FormStored["state"] | undefined;
    const delivery = await deliver(drafts, id, submission, async (form) => {
      const receipt = await tablet.submit(form);
      next = receipt.state;
      return receipt;
    });
    switch (delivery.kind) {
      case "later":
        setPhase({ name: "sending", offline: true });
        timer.current = setTimeout(() => void attempt(id, submission), RETRY_MS);
        return;
      case "held":
        setPhase({ name: "held", error: delivery.error });
        return;
      case "refused":
        if (form.current === null) return;
        setPhase({ name: "filling", form: form.current, refused: delivery.error });
        return;
      case "stored":
      case "superseded":
      case "withdrawn":
        setPhase({ name: "done" });
        if (next === undefined) settled.current();
        else stored.current(next);
        return;
      case "unpaired":
        settled.current();
    }
  }, []);

  useEffect(() => {
    if (early !== null) {
      // From now on the form is this view's: a later one begins with what is stored.
      forgetEarlyForm();
      return () => clearTimeout(timer.current);
    }
    let cancelled = false;
    void drafts.open(sessionId, administration.key, new Date()).then((opened) => {
      if (cancelled) return;
      form.current = opened;
      if (opened.queued === null) setPhase({ name: "filling", form: opened, refused: null });
      else {
        setPhase({ name: "sending", offline: false });
        void attempt(opened.id, opened.queued);
      }
    });
    return () => {
      cancelled = true;
      clearTimeout(timer.current);
    };
  }, [sessionId, administration.key, attempt, early]);

  const storeDraft = (draft: FormDraft) => {
    if (form.current === null) return;
    form.current = { ...form.current, draft };
    void drafts.keep(form.current.id, draft);
  };

  const send = (answers: Readonly<Record<string, Answer>>, draft: FormDraft) => {
    const opened = form.current;
    if (opened === null) return;
    setPhase({ name: "sending", offline: false });
    const submission = submissionOf({ ...opened, draft }, administration, language, answers);
    void drafts.queue(opened.id, submission).then((queued) => attempt(opened.id, queued));
  };
  const retry = () => {
    setPhase({ name: "sending", offline: false });
    void drafts.open(sessionId, administration.key, new Date()).then(({ id, queued }) => {
      if (queued !== null) void attempt(id, queued);
    });
  };
  return { phase, storeDraft, send, retry };
}

/** A signature changes many times a second, so it is stored after a pause. */
const STORE_AFTER_MS = 150;

/** An unfinished consent: its statements and signature, restored after a restart of the browser. */
export function useStoredSigning(
  state: TabletState,
): readonly [signing: Signing, change: (signing: Signing) => void] {
  const [signing, setSigning] = useState<Signing>(UNSIGNED);
  const touched = useRef(false);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  // biome-ignore lint/correctness/useExhaustiveDependencies: a consent's page is remounted for each step
  useEffect(() => {
    void drafts.signing(state).then((stored) => {
      if (stored !== undefined && !touched.current) setSigning(stored);
    });
    return () => clearTimeout(timer.current);
  }, []);
  const change = (next: Signing): void => {
    touched.current = true;
    setSigning(next);
    clearTimeout(timer.current);
    timer.current = setTimeout(() => void drafts.keepSigning(state, next), STORE_AFTER_MS);
  };
  return [signing, change];
}

/**
 * Resend the forms whose delivery was never confirmed.
 *
 * When the server's answer is lost, the session may have moved on before this tablet knows. So
 * whenever it hears from the server again, forms that still wait are sent once more: the server
 * recognises the key and confirms, and the tablet deletes them. The form on the screen is delivered
 * by
 * its own screen.
 */
export function useSweep(state: TabletState, connected: boolean): void {
  const { session_id: sessionId, version } = state;
  const shown = state.administration?.key ?? null;
  // biome-ignore lint/correctness/useExhaustiveDependencies: a new version is a reason to sweep again
  useEffect(() => {
    if (connected) void sweep(sessionId, shown);
  }, [sessionId, version, shown, connected]);
}

async function sweep(sessionId: string, shown: string | null): Promise<void> {
  await drafts.forgetOld(new Date());
  for (const stored of await drafts.waiting(sessionId)) {
    if (stored.administration === shown || stored.queued === null) continue;
    await deliver(drafts, stored.id, stored.queued, tablet.submit);
  }
}
