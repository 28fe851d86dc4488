/** Forms that are sent once, however often and fast somebody clicks on their button. */
import type { UseMutationResult } from "@tanstack/react-query";
import { type FormEvent, useState } from "react";

type Send<Variables> = (variables: Variables) => Promise<unknown>;

interface Options {
  /** Whether the form stays, to be sent again with something else, when it has been sent. */
  readonly isReused: boolean;
}

/**
 * Return a function that sends unless it is sending already. It knows without the page having been
 * drawn meanwhile, which on a slow computer is too late for the second of two clicks. What failed
 * can be sent again; what was sent, only in a form that is reused.
 */
export function singly<Variables>({ isReused }: Options) {
  let isTaken = false;
  const release = () => {
    isTaken = false;
  };
  return (send: Send<Variables>, variables: Variables): void => {
    if (isTaken) return;
    isTaken = true;
    void send(variables).then(isReused ? release : undefined, release);
  };
}

/** Return a form's submit, which starts its mutation unless that is running or has succeeded. */
export function useSingleSubmit<Variables>(
  mutation: Pick<UseMutationResult<unknown, Error, Variables>, "mutateAsync">,
  options: Options = { isReused: false },
): (variables: Variables) => void {
  const [once] = useState(() => singly<Variables>(options));
  return (variables) => once(mutation.mutateAsync, variables);
}

/** Return the handler of a form that needs no variables: it is sent once, and no page is loaded. */
export function useFormSubmit(
  mutation: Pick<UseMutationResult<unknown, Error, void>, "mutateAsync">,
  options?: Options,
): (event: FormEvent) => void {
  const submit = useSingleSubmit(mutation, options);
  return (event) => {
    event.preventDefault();
    submit();
  };
}
