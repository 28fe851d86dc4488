import { useEffect } from "react";

/** The title of the browser's tab: the page, then the product. */
export function useTitle(title: string): void {
  useEffect(() => {
    document.title = title === "" ? "Reembody" : `${title} · Reembody`;
  }, [title]);
}
