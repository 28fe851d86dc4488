/** A longer text of the study as paragraphs and points; never as HTML. */
import { type Paragraph, paragraphs } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Points } from "@shared/ui/Points";
import { type JSX, useEffect, useRef, useState } from "react";
import { useTexts } from "../i18n";
import { Picture } from "../pictures/Picture";
import classes from "./screens.module.css";

export function Prose({ text }: { readonly text: string }): JSX.Element {
  return (
    <div className={classes.prose}>
      {paragraphs(text).map((paragraph, index) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: the parts of a text have no other identifier
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
      return <Points points={paragraph.points} />;
  }
}

/** A hint that there is more to read, until the end of the text has been visible. */
export function ScrollHint(): JSX.Element {
  const { t } = useTexts();
  const end = useRef<HTMLSpanElement>(null);
  const [hasMore, setHasMore] = useState(false);
  useEffect(() => {
    if (end.current === null) return;
    const observer = new IntersectionObserver(([entry]) =>
      setHasMore(entry?.isIntersecting === false),
    );
    observer.observe(end.current);
    return () => observer.disconnect();
  }, []);
  return (
    <>
      <span ref={end} />
      {hasMore && (
        <button
          type="button"
          className={classes.more}
          onClick={() => window.scrollBy({ top: window.innerHeight * 0.75, behavior: "smooth" })}
        >
          {t("reading.more")}
          <Icon name="down" />
        </button>
      )}
    </>
  );
}
