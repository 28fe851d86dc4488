/** Says that there is more to read, until the end of the text has been in sight. */
import { Icon } from "@shared/ui/Icon";
import { type JSX, useEffect, useRef, useState } from "react";
import { useTexts } from "../i18n";
import classes from "./screens.module.css";

export function ScrollHint(): JSX.Element {
  const { t } = useTexts();
  const end = useRef<HTMLSpanElement>(null);
  const [more, setMore] = useState(false);
  useEffect(() => {
    if (end.current === null) return;
    const observer = new IntersectionObserver(([entry]) =>
      setMore(entry?.isIntersecting === false),
    );
    observer.observe(end.current);
    return () => observer.disconnect();
  }, []);
  return (
    <>
      <span ref={end} />
      {more && (
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
