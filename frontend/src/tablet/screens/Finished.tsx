import type { TabletState } from "@shared/api/types";
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { Prose } from "./Prose";
import classes from "./screens.module.css";

/** The end of the visit. */
export function Finished({ state }: { readonly state: TabletState }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.calm}>
      <Mark size={64} />
      <h1 className={classes.calmTitle}>{t("finished.title")}</h1>
      <div className={classes.calmText}>
        {state.text === null ? t("finished.body") : <Prose text={state.text} />}
      </div>
    </div>
  );
}
