/**
 * The paper's verification: does the movement keep its character on avatars of several statures?
 */
import { Figure } from "@charts/Figure";
import { Button, Center, Loader, Title } from "@mantine/core";
import type { AnatomyNotice, Capture, Verification } from "@shared/api/captures";
import { number } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useMemo, useState } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { type Key, useTexts } from "../i18n";
import { EmptyState } from "../ui/EmptyState";
import { AnatomyNotices } from "./AnatomyNotices";
import { AvatarChips } from "./AvatarChips";
import { PAPER_AVATARS, statureOf } from "./avatars";
import { NoAvatar, type TabProps } from "./NoAvatar";
import { verificationQuery } from "./queries";
import classes from "./Verification.module.css";
import { VerificationSummary } from "./VerificationSummary";
import { VerificationTable } from "./VerificationTable";
import { anglesFigure, type FigureWords, liftsFigure, toeFigure } from "./verificationFigures";

export function VerificationTab({ capture, map }: TabProps): JSX.Element {
  const { t } = useTexts();
  const [avatars, setAvatars] = useState(PAPER_AVATARS);
  const [lockFeet, setLockFeet] = useState(false);
  const canMove = capture.has_skeleton && map.view?.usable !== false;
  const query = useQuery({
    ...verificationQuery(capture, avatars, lockFeet, map.view?.version ?? 0),
    enabled: canMove && map.view !== undefined && avatars.length > 0,
  });
  if (!capture.has_skeleton) {
    return (
      <EmptyState icon="chart" title={t("verify.impossible")}>
        {t("capture.noAvatar.skeleton", { why: capture.summary.no_skeleton ?? "" })}
      </EmptyState>
    );
  }
  return (
    <div className={classes.tab}>
      <p className={classes.lead}>{t("verify.lead")}</p>
      <NoAvatar capture={capture} map={map} />
      <AvatarChips
        avatars={avatars}
        lockFeet={lockFeet}
        busy={query.isFetching}
        onAvatars={setAvatars}
        onLockFeet={setLockFeet}
      />
      {query.isError && (
        <>
          <Failure error={query.error} onRetry={() => void query.refetch()} />
          <div>
            <Button
              component={Link}
              href={`/captures/${capture.id}/joints`}
              variant="default"
              size="xs"
            >
              {t("capture.noAvatar.openMap")}
            </Button>
          </div>
        </>
      )}
      {query.data === undefined && query.isFetching && (
        <Center mih={280}>
          <Loader role="status" aria-label={t("verify.busy")} />
        </Center>
      )}
      {query.data !== undefined && !query.isError && (
        <VerificationResult capture={capture} verification={query.data} />
      )}
    </div>
  );
}

interface VerificationResultProps {
  readonly capture: Capture;
  readonly verification: Verification;
}

function VerificationResult({ capture, verification }: VerificationResultProps): JSX.Element {
  const { t } = useTexts();
  const words = useFigureWords();
  const figures = useMemo(
    () => ({
      toe: toeFigure(verification, words),
      lifts: liftsFigure(verification, words),
      angles: anglesFigure(verification, words),
    }),
    [verification, words],
  );
  return (
    <>
      <VerificationSummary verification={verification} />
      <AnatomyNotices notices={oncePerRule(verification)} />
      <VerificationTable capture={capture} verification={verification} />
      {verification.unmapped_body_joints.length > 0 && (
        <p className={classes.soft}>
          {t("verify.unmapped", {
            names: verification.unmapped_body_joints
              .map((joint) => t(`joint.${joint}` as Key))
              .join(", "),
          })}
        </p>
      )}
      {(["toe", "lifts", "angles"] as const).map((name) => (
        <figure key={name} className={classes.figure}>
          <Title order={2} size="h3">
            {t(`verify.${name}`)}
          </Title>
          <figcaption className={classes.soft}>{t(`verify.${name}.caption`)}</figcaption>
          <Figure
            figure={figures[name]}
            label={t(`verify.${name}`)}
            watermark={null}
            loading={t("verify.drawing")}
            failed={t("verify.notDrawn")}
          />
        </figure>
      ))}
    </>
  );
}

/** The notices on the walk: each rule once, since most of them hold for every avatar. */
function oncePerRule({ avatars }: Verification): readonly AnatomyNotice[] {
  const found = new Map<string, AnatomyNotice>();
  for (const notice of avatars.flatMap(({ notices }) => notices)) {
    if (!found.has(notice.rule)) found.set(notice.rule, notice);
  }
  return [...found.values()];
}

function useFigureWords(): FigureWords {
  const { t, language } = useTexts();
  // Depends on the language alone: a new table of words at each render would redraw the figures.
  // biome-ignore lint/correctness/useExhaustiveDependencies: `t` follows the language.
  return useMemo(
    () => ({
      left: t("verify.left"),
      right: t("verify.right"),
      time: t("verify.time"),
      hip: t("verify.angle.hip"),
      knee: t("verify.angle.knee"),
      ankle: t("verify.angle.ankle"),
      forwardLeft: t("verify.toe.forward.left"),
      forwardRight: t("verify.toe.forward.right"),
      height: t("verify.toe.height"),
      body: (name) =>
        name === "source"
          ? t("verify.source")
          : t("capture.avatar.cm", { value: number(statureOf(name), language) }),
      lift: (side, from, to) =>
        t("verify.lift", { side, from: number(from, language), to: number(to, language) }),
    }),
    [language],
  );
}
