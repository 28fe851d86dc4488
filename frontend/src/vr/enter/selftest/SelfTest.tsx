/** The test of this headset on its page: the button, how far it is, and the verdicts. */
import { Progress as Bar, Button, Title } from "@mantine/core";
import { clockFace } from "@shared/format";
import { ErrorNotice, errorTexts, Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { type JSX, useEffect, useRef } from "react";
import { useTexts } from "../../i18n";
import { PLAN, planDurationS } from "../../selftest/plan";
import { PREPARED_WITHIN_S } from "../../selftest/preparation";
import { LEAST_DURATION_S } from "../../selftest/report";
import type { Progress } from "../../selftest/screens";
import classes from "./SelfTest.module.css";
import type { SelfTestState } from "./useSelfTest";
import { Verdicts } from "./Verdicts";

interface OfferProps {
  readonly test: SelfTestState;
  /** Without VR the test runs on the screen. */
  readonly hasVr: boolean;
  readonly onScreen: () => void;
}

/** The button below the one that enters the study, and reports that still wait. */
export function SelfTestOffer({ test, hasVr, onScreen }: OfferProps): JSX.Element {
  const { t } = useTexts();
  return (
    <section className={classes.offer} aria-label={t("selftest.title")}>
      <Button
        variant="default"
        size="lg"
        className={classes.button ?? ""}
        disabled={!test.isPossible}
        onClick={hasVr ? test.begin : onScreen}
      >
        {t(hasVr ? "selftest.button" : "selftest.buttonOnScreen")}
      </Button>
      {test.isHeldBack && <p className={classes.what}>{t("selftest.heldBack")}</p>}
      <p className={classes.what}>{t("selftest.what")}</p>
      {test.isOvertaken && (
        <Notice tone="info" title={t("selftest.visit.title")}>
          {t("selftest.visit.body")}
        </Notice>
      )}
      {test.waiting === 0 && test.error !== null && (
        <Notice tone="bad" title={t("selftest.failed.title")}>
          {test.error instanceof Error ? test.error.message : String(test.error)}
        </Notice>
      )}
      <Waiting test={test} />
    </section>
  );
}

/** How far the test is, and its verdicts, in place of the study's page. */
export function SelfTestResult({ test }: { readonly test: SelfTestState }): JSX.Element | null {
  const { t } = useTexts();
  const { progress, isShown } = test;
  if (progress === null) return null;
  return (
    <section className={classes.result} aria-label={t("selftest.title")}>
      <div className={classes.head}>
        <Title order={1}>{titleOf(t, progress)}</Title>
        <Said progress={progress} />
      </div>
      {progress.kind === "stored" && <Verdicts view={progress.view} />}
      <Waiting test={test} />
      <div className={classes.actions}>
        {isShown && progress.kind === "measuring" && (
          <Button size="lg" variant="default" onClick={test.stop}>
            {t("selftest.stop")}
          </Button>
        )}
        {!isShown && progress.kind !== "sending" && (
          <Button size="lg" onClick={test.close}>
            {t("selftest.back")}
          </Button>
        )}
      </div>
    </section>
  );
}

interface ScreenProps {
  readonly test: SelfTestState;
  readonly onEnd: () => void;
}

/** The test in a window on this screen, where no headset is. */
export function SelfTestOnScreen({ test, onEnd }: ScreenProps): JSX.Element {
  const { t } = useTexts();
  const host = useRef<HTMLDivElement>(null);
  const { beginOn, progress } = test;
  useEffect(() => (host.current === null ? undefined : beginOn(host.current)), [beginOn]);
  const isOver = progress !== null && OVER.has(progress.kind);
  useEffect(() => {
    if (isOver) onEnd();
  }, [isOver, onEnd]);
  return (
    <div className={classes.screen}>
      <div ref={host} className={classes.host} data-testid="self-test" />
      {progress !== null && (
        <div className={classes.strip}>
          <div>
            <strong>{titleOf(t, progress)}</strong>
            <Said progress={progress} />
          </div>
          <Button variant="default" onClick={test.stop}>
            {t("selftest.stop")}
          </Button>
        </div>
      )}
    </div>
  );
}

const OVER: ReadonlySet<Progress["kind"]> = new Set(["kept", "short", "unseen", "stored"]);

function titleOf(t: ReturnType<typeof useTexts>["t"], progress: Progress): string {
  switch (progress.kind) {
    case "measuring":
      return t(`selftest.${progress.place.movement}.title`);
    case "stored":
      return t(`selftest.${progress.view.status}.title`);
    default:
      return t(`selftest.${progress.kind}.title`);
  }
}

/** The sentence below the title, and how much is left. */
function Said({ progress }: { readonly progress: Progress }): JSX.Element | null {
  const { t } = useTexts();
  if (progress.kind === "stored") return null;
  if (progress.kind === "short") {
    return <p>{t("selftest.short.body", { seconds: LEAST_DURATION_S })}</p>;
  }
  if (progress.kind === "preparing") {
    const waited = { waited: progress.waitedS, most: PREPARED_WITHIN_S };
    const said = t(`selftest.awaited.${progress.awaited}`, waited);
    return (
      <>
        <p>{t("selftest.preparing.body")}</p>
        <Bar
          value={(100 * progress.waitedS) / PREPARED_WITHIN_S}
          aria-label={said}
          className={classes.bar ?? ""}
        />
        <p className={classes.left}>{said}</p>
      </>
    );
  }
  if (progress.kind !== "measuring") return <p>{t(`selftest.${progress.kind}.body`)}</p>;
  const { place, isScripted } = progress;
  const wholeS = planDurationS(PLAN);
  const left = t("selftest.left", { time: clockFace(seconds(Math.ceil(place.leftS))) });
  return (
    <>
      <p>{t(isScripted ? "selftest.scripted" : `selftest.${place.movement}.body`)}</p>
      <Bar
        value={100 * (1 - place.leftS / wholeS)}
        aria-label={left}
        className={classes.bar ?? ""}
      />
      <p className={classes.left}>
        {t("selftest.step", { number: place.number, total: place.total })}, {left}
      </p>
    </>
  );
}

/** Reports that are safe on this device and not stored yet, and why. */
function Waiting({ test }: { readonly test: SelfTestState }): JSX.Element | null {
  const { t } = useTexts();
  const { waiting, refused, error, sendNow, discard } = test;
  if (waiting === 0) return null;
  const again = (
    <Button size="xs" variant="default" onClick={sendNow}>
      {t("selftest.retry")}
    </Button>
  );
  return (
    <>
      <Notice tone="info" actions={again}>
        {t("selftest.waiting", { count: waiting })}
      </Notice>
      {refused.map((one) => (
        <ErrorNotice key={one.id} error={one.error} texts={errorTexts(t)} />
      ))}
      {refused.length > 0 && (
        <Notice
          tone="warn"
          actions={
            <Button size="xs" variant="default" onClick={discard}>
              {t("selftest.discard", { count: refused.length })}
            </Button>
          }
        >
          {t("selftest.refused", { count: refused.length })}
        </Notice>
      )}
      {error !== null && refused.length < waiting && (
        <ErrorNotice error={error} texts={errorTexts(t)} />
      )}
    </>
  );
}
