/**
 * What the study is: its question, its conditions, its orders, and the session minute by minute.
 */
import { Anchor, Paper, Title } from "@mantine/core";
import type { StudyDetail, StudyProtocol } from "@shared/api/types";
import { latency } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Notice } from "@shared/ui/Notice";
import { milliseconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { savedAvatarsQuery } from "../../avatarEditor/tryout/source";
import { type Key, useTexts } from "../../i18n";
import { useWalksBack } from "../../pilot/walksBack";
import classes from "./Overview.module.css";
import { orderCount } from "./orderCount";
import { Procedure } from "./Procedure";

export function Overview({ study }: { readonly study: StudyDetail }): JSX.Element {
  return study.protocol === null ? (
    <BlindedOverview study={study} />
  ) : (
    <FullOverview study={study} protocol={study.protocol} />
  );
}

/** The overview for operators who run the study without knowing its conditions. */
function BlindedOverview({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <p className={classes.lead}>{study.description}</p>
      <Notice tone="info" icon="lock" title={t("blind.study.title")}>
        {t("blind.study.body")}
      </Notice>
    </>
  );
}

interface FullOverviewProps {
  readonly study: StudyDetail;
  readonly protocol: StudyProtocol;
}

function FullOverview({ study, protocol }: FullOverviewProps): JSX.Element {
  const { t, language } = useTexts();
  const walksBackMin = useWalksBack(study.key, study.content_hash);
  return (
    <>
      <p className={classes.lead}>{inLanguage(protocol.description, language)}</p>
      <div className={classes.grid}>
        <Paper className={classes.wide ?? ""}>
          <Title order={2} mb="md">
            {t("overview.procedure")}
          </Title>
          <Procedure study={study} protocol={protocol} walksBackMin={walksBackMin} />
        </Paper>
        <Paper>
          <Title order={2} mb="md">
            {t("overview.conditions")}
          </Title>
          <Conditions protocol={protocol} />
        </Paper>
        <Paper>
          <Title order={2} mb="md">
            {t("overview.design")}
          </Title>
          <Design study={study} protocol={protocol} />
        </Paper>
      </div>
    </>
  );
}

function Conditions({ protocol }: { readonly protocol: StudyProtocol }): JSX.Element {
  const { t, language } = useTexts();
  const longest = Math.max(1, ...protocol.conditions.map((condition) => condition.latency_ms));
  return (
    <table className={classes.conditions}>
      <thead>
        <tr>
          <th scope="col">{t("overview.condition")}</th>
          <th scope="col">{t("overview.addedLatency")}</th>
          <td />
        </tr>
      </thead>
      <tbody>
        {protocol.conditions.map((condition) => (
          <tr key={condition.key}>
            <td>
              {inLanguage(condition.label, language)}
              {condition.body !== undefined && (
                <span className={classes.body}>{t("overview.body", { body: condition.body })}</span>
              )}
            </td>
            <td className="numbers">{latency(milliseconds(condition.latency_ms))}</td>
            <td aria-hidden="true" width="40%">
              <div
                className={classes.bar}
                style={{ width: `${(condition.latency_ms / longest) * 100}%` }}
              />
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Design({ study, protocol }: FullOverviewProps): JSX.Element {
  const { t } = useTexts();
  const { orders, conditions, blinding, on_disconnect, procedure } = protocol;
  const count = orderCount(orders, conditions.length);
  const facts: readonly (readonly [string, string])[] = [
    [t("design.design"), t(DESIGNS[orders.design] ?? "design.explicit")],
    [
      t("design.orders"),
      t("design.ordersValue", {
        count,
        replicates: orders.replicates,
        total: count * orders.replicates,
      }),
    ],
    [t("design.whenFull"), t(orders.when_full === "grow" ? "design.grow" : "design.closed")],
    [
      t("design.limbs"),
      t(procedure.block.limb_order === "fixed" ? "design.fixed" : "design.alternate"),
    ],
    [t("design.blinding"), t(blinding.operator ? "design.blinded" : "design.open")],
    [t("design.disconnect"), t(on_disconnect === "pause" ? "design.pause" : "design.continue")],
    [
      t("design.languages"),
      study.languages.map((tag) => t(tag === "de" ? "language.de" : "language.en")).join(", "),
    ],
    [t("design.seed"), String(orders.seed)],
  ];
  return (
    <dl className={classes.facts}>
      <Avatar protocol={protocol} />
      {facts.map(([name, value]) => (
        <div key={name} style={{ display: "contents" }}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

/** The avatar that the study names, with its version and hash, and the way to it. */
function Avatar({ protocol }: { readonly protocol: StudyProtocol }): JSX.Element | null {
  const { t } = useTexts();
  const named = protocol.avatar_configuration ?? null;
  const { data } = useQuery({ ...savedAvatarsQuery, enabled: named !== null });
  if (named === null) return null;
  const found = data?.find(({ key }) => key === named.key);
  const hash = found?.content_hashes[named.version - 1];
  return (
    <>
      <dt>{t("design.avatar")}</dt>
      <dd className="numbers">
        <Anchor component={Link} href={`/avatars/${named.key}/${named.version}`} inherit>
          {t("tryout.compare.version", {
            title: found?.title ?? named.key,
            number: named.version,
          })}
        </Anchor>
        {hash !== undefined && (
          <>
            {" "}
            <code title={hash}>{hash.slice(0, 12)}</code>
          </>
        )}
      </dd>
    </>
  );
}

const DESIGNS: Readonly<Record<string, Key>> = {
  all_permutations: "design.permutations",
  williams: "design.williams",
  explicit: "design.explicit",
};
