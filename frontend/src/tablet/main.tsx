import { mountPage } from "@shared/ui/Page";
import { translations } from "./i18n";
import { Tablet } from "./Tablet";

export function mount(): void {
  mountPage({ translations, isAtOnce: true, children: <Tablet /> });
  void enableOfflineUse();
}

/**
 * Let this page open without a network: register the service worker, and ask the browser to keep
 * the tablet's data when storage is scarce.
 *
 * This needs a connection that the browser trusts (https, or localhost); without one there are no
 * service workers, and the tablet works as long as its page stays open.
 */
async function enableOfflineUse(): Promise<void> {
  // The development server builds no worker.
  if (!import.meta.env.PROD || !window.isSecureContext || !("serviceWorker" in navigator)) return;
  try {
    await navigator.serviceWorker.register("/tablet-worker.js", { scope: "/tablet" });
    await navigator.storage.persist();
  } catch {
    // The certificate is not trusted, or the browser has no space. Nothing else depends on the
    // worker, and nobody at the tablet could do anything about it.
  }
}
