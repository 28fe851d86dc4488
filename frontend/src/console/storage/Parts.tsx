/** Each part with its size, longest first, as bars of one scale. */
import type { StoragePart } from "@shared/api/housekeeping";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { bytes } from "../ui/bytes";
import classes from "./Storage.module.css";

export function Parts({ parts }: { readonly parts: readonly StoragePart[] }): JSX.Element {
  const { t, language } = useTexts();
  const most = Math.max(1, ...parts.map((part) => part.bytes));
  return (
    <ul className={classes.parts}>
      {parts.map((part) => (
        <li key={part.place}>
          <div className={classes.partName}>
            {t(`storage.part.${part.place}`)}
            <span className={classes.about}>{t(`storage.part.${part.place}.about`)}</span>
          </div>
          <div className={`${classes.partSize} numbers`}>
            {bytes(part.bytes, language)}
            {typeof part.files === "number" && (
              <span className={classes.about}>{t("storage.files", { count: part.files })}</span>
            )}
          </div>
          <div className={classes.track} aria-hidden="true">
            <span className={classes.fill} style={{ width: `${(100 * part.bytes) / most}%` }} />
          </div>
        </li>
      ))}
    </ul>
  );
}
