/** The points of a study's text as a list. */
import type { JSX } from "react";

export function Points({ points }: { readonly points: readonly string[] }): JSX.Element {
  return (
    <ul>
      {points.map((point) => (
        <li key={point}>{point}</li>
      ))}
    </ul>
  );
}
