/**
 * Send one queued form to the server, and return how it ended.
 *
 *     stored       the server has it (or had it already): the device deletes it
 *     later        no connection, or the server cannot take it now: try again
 *     unpaired     the device has lost its session: kept until it is paired again
 *     held         this form is not due now: kept, the experimenter decides
 *     superseded   the experimenter has recorded this form already: the device deletes it
 *     withdrawn    the participant has withdrawn or was erased: the device deletes all their forms
 *     refused      the answers are invalid: returned to be corrected
 */
import { ApiError } from "../api/request";
import type { Receipt, Submission } from "../api/types";
import { type StoredForms, sessionOf } from "./storedForms";

export type Delivery =
  | { readonly kind: "stored" | "later" | "unpaired" | "superseded" | "withdrawn" }
  | { readonly kind: "held" | "refused"; readonly error: ApiError };

export type Submit = (submission: Submission) => Promise<Receipt>;

/** Deliveries that are under way or done, by idempotency key: one page sends no form twice. */
const sent = new Map<string, Promise<Delivery>>();

/**
 * Deliver a form once: when the screen and the sweep both ask for it, the second waits for the
 * first.
 */
export function deliver(
  store: StoredForms,
  id: string,
  submission: Submission,
  submit: Submit,
): Promise<Delivery> {
  const key = submission.idempotency_key;
  const before = sent.get(key);
  if (before !== undefined) return before;
  const delivery = sendForm(store, id, submission, submit).then((ended) => {
    if (ended.kind !== "stored") sent.delete(key);
    return ended;
  });
  sent.set(key, delivery);
  return delivery;
}

async function sendForm(
  store: StoredForms,
  id: string,
  submission: Submission,
  submit: Submit,
): Promise<Delivery> {
  try {
    await submit(submission);
  } catch (error) {
    const delivery = deliveryOf(error);
    if (delivery.kind === "refused") await store.reopen(id);
    if (delivery.kind === "superseded") await store.forget(id);
    if (delivery.kind === "withdrawn") await store.forgetSession(sessionOf(id));
    return delivery;
  }
  await store.forget(id);
  return { kind: "stored" };
}

function deliveryOf(error: unknown): Delivery {
  if (!(error instanceof ApiError)) return { kind: "later" };
  if (error.status === 401) return { kind: "unpaired" };
  if (error.code === "withdrawn") return { kind: "withdrawn" };
  if (error.code === "not_now") return { kind: "held", error };
  if (error.code === "conflict") return { kind: "superseded" };
  if (error.status === 422 || error.status === 413) return { kind: "refused", error };
  return { kind: "later" };
}
