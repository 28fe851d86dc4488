/** A longer text of the study as paragraphs, points and pictures; never as HTML. */
import type { JSX } from "react";
import { type Paragraph, paragraphs } from "../text";
import { Points } from "../ui/Points";
import { Picture, type PictureKey } from "./Picture";
import classes from "./Prose.module.css";

interface ProseProps {
  readonly text: string;
  /** What the pictures show, in the language of the page. */
  readonly t: (key: PictureKey) => string;
}

export function Prose({ text, t }: ProseProps): JSX.Element {
  return (
    <div className={classes.prose}>
      {paragraphs(text).map((paragraph, index) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: the parts of a text have no other identifier
        <Part key={index} paragraph={paragraph} t={t} />
      ))}
    </div>
  );
}

interface PartProps extends Pick<ProseProps, "t"> {
  readonly paragraph: Paragraph;
}

function Part({ paragraph, t }: PartProps): JSX.Element {
  switch (paragraph.kind) {
    case "heading":
      return <h2>{paragraph.text}</h2>;
    case "picture":
      return <Picture name={paragraph.name} t={t} />;
    case "prose":
      return <p>{paragraph.text}</p>;
    case "points":
      return <Points points={paragraph.points} />;
  }
}
