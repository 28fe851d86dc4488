/** What a dialog is about, kept while it fades out: without it the dialog would lose its name. */
import { useState } from "react";

export function useShown<T>(subject: T | null): T | null {
  const [shown, setShown] = useState(subject);
  if (subject !== null && subject !== shown) setShown(subject);
  return subject ?? shown;
}
