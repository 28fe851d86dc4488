/**
 * The line above every page while a scripted participant is running: where it is, a link to it, and
 * a stop button. It takes a place of its own, so that it covers nothing.
 *
 * The page goes to its session as soon as there is one, and the tour starts if it was never seen.
 */
import { Button, Loader } from "@mantine/core";
import type { Tryout } from "@shared/api/housekeeping";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import { useLocation } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Tour.module.css";
import { studyLanguage, useStartTryout, useStopTryout, useTryout } from "./TryIt";
import { startTour, useTourStep, wasSeen } from "./tourStore";

const isOn = ({ state }: Tryout): boolean => state === "starting" || state === "running";

export function TryoutBar(): JSX.Element | null {
  const tryout = useTryout(true);
  const [address, navigate] = useLocation();
  const [dismissed, dismiss] = useState<string | null>(null);
  const queries = useQueryClient();
  const sawStart = useRef(false);
  const session = tryout?.session_id ?? null;
  useEffect(() => {
    if (tryout?.state === "starting" && tryout.mine) sawStart.current = true;
    if (session === null || !sawStart.current) return;
    // Only a page that saw it start goes to its session, and only once.
    sawStart.current = false;
    void queries.invalidateQueries({ queryKey: ["studies"] });
    navigate(`/sessions/${session}`);
    if (!wasSeen()) startTour();
  }, [tryout, session, queries, navigate]);
  // A finished one has been read when somebody goes on to another page.
  const isOver = tryout?.state === "done" || tryout?.state === "stopped";
  const [overAt, setOverAt] = useState<string | null>(null);
  if (isOver && overAt === null) setOverAt(address);
  if (!isOver && overAt !== null) setOverAt(null);
  const wasOn = useRef(false);
  if (tryout !== null && isOn(tryout)) wasOn.current = true;
  // Do not report one that had ended before the page was opened.
  if (tryout === null || !wasOn.current || dismissed === tryout.started_at) return null;
  if (isOver && overAt !== null && overAt !== address) return null;
  const watching = session !== null && address === `/sessions/${session}`;
  return (
    <Bar
      tryout={tryout}
      watching={watching}
      onWatch={() => navigate(`/sessions/${session}`)}
      onClose={() => dismiss(tryout.started_at)}
    />
  );
}

interface BarProps {
  readonly tryout: Tryout;
  readonly watching: boolean;
  readonly onWatch: () => void;
  readonly onClose: () => void;
}

function Bar({ tryout, watching, onWatch, onClose }: BarProps): JSX.Element {
  const { t } = useTexts();
  const stop = useStopTryout();
  const touring = useTourStep() !== null;
  return (
    <section
      className={classes.bar}
      data-strip
      data-state={tryout.state}
      aria-label={t("try.label")}
    >
      {tryout.state === "starting" ? <Loader size={17} /> : <Icon name="body" size={17} />}
      <StatusText tryout={tryout} />
      <div className={classes.buttons}>
        {watching && isOn(tryout) && !touring && (
          <Button size="compact-xs" variant="subtle" onClick={startTour}>
            {t("try.tour")}
          </Button>
        )}
        {!watching && tryout.session_id !== null && (
          <Button size="compact-xs" variant="default" onClick={onWatch}>
            {t("try.watch")}
          </Button>
        )}
        {isOn(tryout) ? (
          <Button
            size="compact-xs"
            variant="default"
            loading={stop.isPending}
            leftSection={<Icon name="stop" size={14} />}
            onClick={() => stop.mutate()}
          >
            {t("try.stop")}
          </Button>
        ) : (
          <>
            {tryout.state === "failed" && <RestartButton tryout={tryout} />}
            <Button size="compact-xs" variant="default" onClick={onClose}>
              {t("try.dismiss")}
            </Button>
          </>
        )}
      </div>
      {stop.isError && <Failure error={stop.error} />}
    </section>
  );
}

function StatusText({ tryout }: { readonly tryout: Tryout }): JSX.Element {
  const { t, language } = useTexts();
  const { state, step, trouble } = tryout;
  if (state === "failed") {
    return (
      <div className={classes.words} role="alert">
        <strong>{t(tryout.session_id === null ? "try.failed.start" : "try.failed")}</strong>
        <span>{[trouble?.message, trouble?.remedy].filter(Boolean).join(" ")}</span>
      </div>
    );
  }
  const title = {
    starting: t("try.starting"),
    running: t("try.label"),
    done: t("try.done"),
    stopped: t("try.stopped"),
  }[state];
  const detail =
    state === "running"
      ? [step, t("try.speed", { speed: number(tryout.speed, language, 1) })]
      : state === "starting"
        ? [t("try.starting.body")]
        : [];
  return (
    <div className={classes.words} role="status">
      <strong>{title}</strong>
      <span className="numbers">{detail.filter(Boolean).join(" · ")}</span>
    </div>
  );
}

function RestartButton({ tryout }: { readonly tryout: Tryout }): JSX.Element {
  const { t, language } = useTexts();
  const start = useStartTryout();
  return (
    <Button
      size="compact-xs"
      loading={start.isPending}
      onClick={() =>
        start.mutate({ studyKey: tryout.study_key, language: studyLanguage([language], language) })
      }
    >
      {t("try.again")}
    </Button>
  );
}
