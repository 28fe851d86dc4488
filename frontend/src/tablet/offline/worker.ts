/**
 * Open the tablet's page without a network, even after its browser was killed.
 *
 * When this service worker is installed, it caches the page and its hashed files; a new build is a
 * different worker, which takes over once it has cached all of its own files. What a participant
 * enters is stored elsewhere: see `drafts/store.ts`.
 */
import { type Build, cacheName, outdated, planFor } from "./plan";

interface Lasting extends Event {
  waitUntil(done: Promise<unknown>): void;
}

interface FetchEventLike extends Lasting {
  readonly request: Request;
  respondWith(answer: Promise<Response>): void;
}

interface Worker {
  readonly BUILD: Build;
  readonly clients: { claim(): Promise<void> };
  skipWaiting(): Promise<void>;
  addEventListener(type: "install" | "activate", listener: (event: Lasting) => void): void;
  addEventListener(type: "fetch", listener: (event: FetchEventLike) => void): void;
}

const worker = self as unknown as Worker;
const build = worker.BUILD;
const own = cacheName(build.version);
/** A server that does not answer within this time is treated as unreachable. */
const PATIENCE_MS = 3000;

worker.addEventListener("install", (event) => event.waitUntil(install()));
worker.addEventListener("activate", (event) => event.waitUntil(takeOver()));
worker.addEventListener("fetch", (event) => {
  const plan = planFor(event.request, location.origin, build.page);
  if (plan === "page") event.respondWith(page(event.request));
  if (plan === "asset") event.respondWith(asset(event.request));
});

async function install(): Promise<void> {
  try {
    await cacheAll(await caches.open(own));
  } catch (error) {
    // An incomplete cache is useless; the previous worker stays, and the next start tries again.
    await caches.delete(own);
    throw error;
  }
  await worker.skipWaiting();
}

async function cacheAll(cache: Cache): Promise<void> {
  await cache.addAll(build.files);
  // Without the cookie, so that no participant's screen is in the page that is kept.
  const fetched = await fetch(build.page, { cache: "no-cache", credentials: "omit" });
  // The server may have a newer build by now; its page needs that build's worker.
  const script = build.files[0] ?? "";
  if (!fetched.ok || !(await fetched.clone().text()).includes(script)) {
    throw new Error(`${build.page} is not of this worker's build.`);
  }
  await cache.put(build.page, fetched);
}

async function takeOver(): Promise<void> {
  await Promise.all(outdated(await caches.keys(), own).map((name) => caches.delete(name)));
  await worker.clients.claim();
}

async function page(request: Request): Promise<Response> {
  const cached = await (await caches.open(own)).match(build.page);
  if (cached === undefined) return fetch(request);
  const late = new Promise<undefined>((resolve) => {
    setTimeout(() => resolve(undefined), PATIENCE_MS);
  });
  const fresh = await Promise.race([fetch(request).catch(() => undefined), late]);
  return fresh?.ok ? fresh : cached;
}

async function asset(request: Request): Promise<Response> {
  return (await caches.match(request)) ?? fetch(request);
}
