/** Bytes that the browser would still store for this site; Infinity where it does not tell. */
export async function storageRoom(storage = globalThis.navigator?.storage): Promise<number> {
  try {
    const { quota, usage } = await storage.estimate();
    return quota === undefined ? Number.POSITIVE_INFINITY : quota - (usage ?? 0);
  } catch {
    return Number.POSITIVE_INFINITY;
  }
}
