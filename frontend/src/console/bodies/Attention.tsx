/** What about a body asks for attention before somebody wears it, in a few words. */
import type { BodyListed } from "@shared/api/bodies";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";
import classes from "./Bodies.module.css";

const WORDS: Readonly<Record<string, Key>> = {
  reach: "bodies.attention.reach",
  triangles: "bodies.attention.triangles",
  wearing: "bodies.attention.wearing",
};

export function Attention({ body }: { readonly body: BodyListed }): JSX.Element | null {
  const { t, language } = useTexts();
  const found = body.attention.flatMap((key) => WORDS[key] ?? []);
  if (found.length === 0) return null;
  const values = {
    off: decimals(100 * (body.reach_off_m ?? 0), language, 0),
    count: number(body.triangles ?? 0, language),
  };
  return (
    <span className={classes.attention}>
      <Icon name="alert" size={16} />
      <span>
        <span className="visually-hidden">{t("bodies.status.warn")}: </span>
        {found.map((key) => (
          <span key={key} className={classes.attentionLine}>
            {t(key, values)}
          </span>
        ))}
      </span>
    </span>
  );
}
