import "./tablet.css";
import { mountPage } from "@shared/ui/Page";
import { translations } from "./i18n";
import { Tablet } from "./Tablet";

mountPage({ translations, children: <Tablet /> });
void keepForOffline();

/**
 * Lets this page open again without a network: registers the service worker, and asks the browser
 * not to throw away what is kept on the tablet when space gets scarce.
 *
 * Only where the browser trusts the connection (https, or localhost); elsewhere there is no such
 * thing, and the tablet works as long as its page stays open.
 */
async function keepForOffline(): Promise<void> {
  // The development server builds no worker.
  if (!import.meta.env.PROD || !window.isSecureContext || !("serviceWorker" in navigator)) return;
  try {
    await navigator.serviceWorker.register("/tablet-worker.js", { scope: "/tablet" });
    await navigator.storage.persist();
  } catch {
    // A certificate that was only clicked away, or a browser without room. Nothing else depends on
    // it, and nobody at the tablet could do anything about it.
  }
}
