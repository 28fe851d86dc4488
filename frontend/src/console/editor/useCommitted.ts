/** A text field that tells of its content when the writer pauses or leaves it, not at every key. */
import { useEffect, useRef, useState } from "react";

const PAUSE_MS = 700;

export function useCommitted(value: string, commit: (value: string) => void) {
  const [local, setLocal] = useState(value);
  const pending = useRef<string | null>(null);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  const latest = useRef(commit);
  useEffect(() => {
    latest.current = commit;
  });
  // What is being written stays; anything else follows the file.
  useEffect(() => {
    if (pending.current === null || pending.current === value) {
      pending.current = null;
      setLocal(value);
    }
  }, [value]);
  const flush = () => {
    clearTimeout(timer.current);
    if (pending.current !== null && pending.current !== value) latest.current(pending.current);
    pending.current = null;
  };
  const flushLater = useRef(flush);
  useEffect(() => {
    flushLater.current = flush;
  });
  useEffect(() => () => clearTimeout(timer.current), []);
  return {
    value: local,
    onChange: (text: string) => {
      setLocal(text);
      pending.current = text;
      clearTimeout(timer.current);
      timer.current = setTimeout(() => flushLater.current(), PAUSE_MS);
    },
    onBlur: flush,
  };
}
