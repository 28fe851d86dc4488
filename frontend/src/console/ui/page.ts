import { useEffect, useState } from "react";

/** Set the title of the browser's tab: the page, then the product. */
export function useTitle(title: string): void {
  useEffect(() => {
    document.title = title === "" ? "Reembody" : `${title} · Reembody`;
  }, [title]);
}

/** Keep what a dialog is about while it fades out: without it the dialog would lose its name. */
export function useShown<T>(subject: T | null): T | null {
  const [shown, setShown] = useState(subject);
  if (subject !== null && subject !== shown) setShown(subject);
  return subject ?? shown;
}
