/** A longer text of the study, and a hint that there is more of it. */
import { Prose as SharedProse } from "@shared/prose/Prose";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useEffect, useRef, useState } from "react";
import { useTexts } from "../i18n";
import classes from "./screens.module.css";

export function Prose({ text }: { readonly text: string }): JSX.Element {
  const { t } = useTexts();
  return <SharedProse text={text} t={t} />;
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
