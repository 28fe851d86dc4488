/** One page at a time may use a journal; the browser takes the lock from a page that dies. */

/** Wait for the lock `name`, at most `timeoutS`; returns what lets go of it, null if it was in vain. */
export async function takeLock(
  name: string,
  timeoutS: number,
  locks: LockManager | undefined = globalThis.navigator?.locks,
): Promise<(() => void) | null> {
  // Browsers hide locks from pages without https; there two pages have to be kept apart by hand.
  if (locks === undefined) return () => undefined;
  return new Promise((resolve, reject) => {
    const held = () => new Promise<void>((release) => resolve(release));
    locks.request(name, { signal: AbortSignal.timeout(timeoutS * 1000) }, held).catch((error) => {
      if (error instanceof DOMException && /^(Timeout|Abort)Error$/.test(error.name)) resolve(null);
      else reject(error);
    });
  });
}
