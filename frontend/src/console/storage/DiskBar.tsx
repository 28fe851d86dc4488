/** The disk as one bar, with a mark where the warning begins. */
import type { StorageRoom } from "@shared/api/housekeeping";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { bytes } from "../ui/bytes";
import { diskShares } from "./diskShares";
import classes from "./Storage.module.css";

export function DiskBar({ room }: { readonly room: StorageRoom }): JSX.Element {
  const { t, language } = useTexts();
  const shares = diskShares(room);
  const size = (value: number): string => bytes(value, language);
  const percent = (value: number): string => `${(100 * value) / Math.max(1, shares.total)}%`;
  const limit = room.disk.warn_below_bytes;
  const told = { own: size(shares.own), other: size(shares.other), free: size(shares.free) };
  return (
    <>
      <p className={`${classes.free} numbers`}>
        {t("storage.disk.free", { free: told.free, total: size(shares.total) })}
      </p>
      <div className={classes.bar} role="img" aria-label={t("storage.disk.bar", told)}>
        <span className={classes.own} style={{ width: percent(shares.own) }} />
        <span className={classes.other} style={{ width: percent(shares.other) }} />
        <span className={classes.mark} style={{ insetInlineEnd: percent(limit) }} />
      </div>
      <ul className={`${classes.legend} numbers`}>
        <li>
          <span className={classes.own} />
          {t("storage.disk.own")} {told.own}
        </li>
        <li>
          <span className={classes.other} />
          {t("storage.disk.other")} {told.other}
        </li>
        <li>
          <span className={classes.markKey} />
          {t("storage.disk.kept", { limit: size(limit) })}
        </li>
      </ul>
    </>
  );
}
