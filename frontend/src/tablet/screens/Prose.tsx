/** A longer text of the study as paragraphs and points; never as HTML. */
import { type Paragraph, paragraphs } from "@shared/text";
import type { JSX } from "react";
import { Picture } from "../pictures/Picture";
import classes from "./screens.module.css";

export function Prose({ text }: { readonly text: string }): JSX.Element {
  return (
    <div className={classes.prose}>
      {paragraphs(text).map((paragraph, index) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: a text has no other names for its parts
        <Part key={index} paragraph={paragraph} />
      ))}
    </div>
  );
}

function Part({ paragraph }: { readonly paragraph: Paragraph }): JSX.Element {
  switch (paragraph.kind) {
    case "heading":
      return <h2>{paragraph.text}</h2>;
    case "picture":
      return <Picture name={paragraph.name} />;
    case "prose":
      return <p>{paragraph.text}</p>;
    case "points":
      return (
        <ul>
          {paragraph.points.map((point) => (
            <li key={point}>{point}</li>
          ))}
        </ul>
      );
  }
}
