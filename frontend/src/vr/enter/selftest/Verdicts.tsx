/** Every figure of a test beside its limit, and what to do about those that are not good. */
import { concerns, errorsOf, limitText, todoText, valueText } from "@shared/selfTest/verdict";
import { Icon, type IconName } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import type { SelfTestView, Verdict } from "../../selftest/report";
import { summaryText } from "../../selftest/screens";
import classes from "./SelfTest.module.css";

const ICONS: Readonly<Record<Verdict["status"], IconName>> = {
  ok: "check",
  warn: "info",
  fail: "alert",
};

export function Verdicts({ view }: { readonly view: SelfTestView }): JSX.Element {
  const { t, language } = useTexts();
  const { verdicts, worn, report } = view;
  const errors = errorsOf(report);
  const listed = concerns(verdicts);
  const fine = verdicts.filter(({ status }) => status === "ok");
  return (
    <>
      <p className={classes.summary}>
        {summaryText(t, view, language)}
        <br />
        {t("selftest.count", { ok: fine.length, total: verdicts.length })} {t("selftest.stored")}{" "}
        {t("selftest.where")}
      </p>
      {!worn && <Notice tone="sim">{t("selftest.notWorn")}</Notice>}
      {errors.length > 0 && (
        <Notice tone="bad" title={t("verdict.page_errors")}>
          {errors.map((error) => (
            <span key={error} className={classes.error}>
              {error}
            </span>
          ))}
        </Notice>
      )}
      <table className={classes.table}>
        <thead>
          <tr>
            <th scope="col">{t("selftest.figure")}</th>
            <th scope="col">{t("selftest.value")}</th>
            <th scope="col">{t("selftest.limit")}</th>
          </tr>
        </thead>
        <tbody>
          {[...listed, ...fine].map((verdict) => (
            <Row key={verdict.code} verdict={verdict} rendering={report.rendering} />
          ))}
        </tbody>
      </table>
    </>
  );
}

interface RowProps {
  readonly verdict: Verdict;
  readonly rendering: SelfTestView["report"]["rendering"];
}

function Row({ verdict, rendering }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const { code, status } = verdict;
  return (
    <tr className={classes[status] ?? ""} data-verdict={code} data-status={status}>
      <th scope="row">
        <span className={classes.name}>
          <Icon name={ICONS[status]} />
          {t(`verdict.${code}`)}
          <span className={classes.status}>{t(`selftest.status.${status}`)}</span>
        </span>
        {status !== "ok" && <p className={classes.remedy}>{todoText(t, verdict, rendering)}</p>}
      </th>
      <td>{valueText(t, verdict, language)}</td>
      <td>{limitText(t, verdict, language) ?? ""}</td>
    </tr>
  );
}
