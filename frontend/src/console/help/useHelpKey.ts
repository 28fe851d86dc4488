/** The key `?`: help about the current page. */
import { useEffect } from "react";
import { isBusy } from "../cockpit/session/keys";
import { useOwnLocation } from "../frame/ownSearch";
import { helpFor } from "./address";

/** In the cockpit and in a replay `?` opens the list of keys instead, which links to the help. */
const LISTS_KEYS = /^\/sessions\/[^/]+(\/replay.*)?$/;

export function useHelpKey(): void {
  const [address, navigate] = useOwnLocation();
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (event.key !== "?" || isBusy(event) || LISTS_KEYS.test(address)) return;
      event.preventDefault();
      if (!address.startsWith("/help")) navigate(helpFor(address));
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  }, [address, navigate]);
}
