/**
 * Tune motors: choose axes, watch the progress, look at each response, accept or reject each axis.
 * What is accepted becomes an edit of the work, which can be undone like any other.
 *
 * The tuning that is shown, and what was accepted of it, stay in the browser for when the page is
 * opened again; the tuning itself is the server's, so several people may watch, stop or resume it.
 */
import { Button, Progress } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import { isApiError } from "@shared/api/request";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useRef, useState } from "react";
import { axisName } from "../../avatarChanges/axes";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { type Choices, hasGains, isTuned } from "./choice";
import { useKeptFocus } from "./focus";
import { KnownTunings } from "./KnownTunings";
import type { TuningPanelProps } from "./props";
import { TuningOrder } from "./TuningOrder";
import { TuningResult } from "./TuningResult";
import { type Tuning, tuningQuery, tunings, tuningsQuery } from "./tunings";

interface Shown {
  readonly id: string;
  readonly choices: Choices;
  /** What was accepted of other tunings that were shown here, also of work that was not saved. */
  readonly others?: Readonly<Record<string, Choices>>;
}

/** Show a tuning, and remember the one that was shown. */
function showing(id: string, shown: Shown | null): Shown {
  const { [id]: choices = {}, ...others } = shown?.others ?? {};
  return shown === null || shown.id === id
    ? { id, choices, others }
    : { id, choices, others: { ...others, [shown.id]: shown.choices } };
}

export function TuningPanel(props: TuningPanelProps): JSX.Element {
  const { avatarKey, base, contentHash, isReadOnly } = props;
  const { t } = useTexts();
  const queries = useQueryClient();
  const [shown, setShown] = useLocalStorage<Shown | null>({
    key: `reembody.tunings.${avatarKey}`,
    defaultValue: null,
  });
  const id = shown?.id ?? "";
  const query = useQuery({ ...tuningQuery(id), enabled: id !== "", retry: false });
  const isGone = id !== "" && isApiError(query.error, "not_found");
  const tuning = id === "" || isGone ? undefined : query.data;
  const put = (next: Tuning) => {
    queries.setQueryData(tuningQuery(next.id).queryKey, next);
    if (next.id !== id) setShown(showing(next.id, shown));
  };
  // The key of the list is the beginning of the key of each.
  const refresh = () => queries.invalidateQueries({ queryKey: tuningsQuery.queryKey });
  const act = useMutation({
    mutationFn: (what: "stop" | "resume") => tunings[what](id),
    onSuccess: put,
    // Somebody else has stopped or resumed it meanwhile: show what it is now.
    onError: refresh,
  });
  const remove = useMutation({
    mutationFn: () => tunings.remove(id),
    onSuccess: () => {
      close();
      return refresh();
    },
    onError: refresh,
  });
  const close = () => {
    const others = shown?.others ?? {};
    setShown(Object.keys(others).length === 0 ? null : { id: "", choices: {}, others });
  };
  // Stop was pressed when the last axis was just measured: the state says all there is to say.
  const isLate = isApiError(act.error, "not_now") && tuning?.state === "ready";
  const failure = (isLate ? null : act.error) ?? remove.error ?? (isGone ? null : query.error);
  const panel = useRef<HTMLDivElement>(null);
  const course = useRef<HTMLElement>(null);
  useKeptFocus(panel, course, panel);
  return (
    <div className={classes.stack} ref={panel} tabIndex={-1}>
      {!isReadOnly && (
        <TuningOrder {...props} isBusy={tuning?.state === "tuning"} onStarted={put} />
      )}
      <KnownTunings
        shown={id}
        avatarKey={avatarKey}
        contents={[base.content_hash, contentHash]}
        remembered={shown?.others ?? {}}
        onShow={(next) => {
          act.reset();
          setShown(showing(next, shown));
        }}
      />
      {id !== "" && failure !== null && <Failure error={failure} />}
      {isGone && (
        <Notice
          tone="info"
          title={t("avatars.tuning.state.gone")}
          actions={
            <Button size="xs" variant="default" onClick={close}>
              {t("avatars.tuning.close")}
            </Button>
          }
        >
          {t("avatars.tuning.state.gone.remedy")}
        </Notice>
      )}
      {tuning !== undefined && (
        <section
          className={classes.panel}
          aria-label={t("avatars.tuning")}
          ref={course}
          tabIndex={-1}
        >
          <Course tuning={tuning} />
          {!isReadOnly && (
            <div className={classes.buttons}>
              {tuning.state === "tuning" && (
                <Button
                  size="xs"
                  variant="default"
                  loading={act.isPending}
                  onClick={() => act.mutate("stop")}
                >
                  {t("action.stop")}
                </Button>
              )}
              {(tuning.state === "stopped" || tuning.state === "failed") && (
                <Button size="xs" loading={act.isPending} onClick={() => act.mutate("resume")}>
                  {t("avatars.tuning.goOn")}
                </Button>
              )}
              {tuning.state !== "tuning" && (
                <Discard
                  key={tuning.id}
                  isPending={remove.isPending}
                  onDiscard={() => remove.mutate()}
                />
              )}
            </div>
          )}
          <TuningResult
            key={tuning.id}
            {...props}
            tuning={tuning}
            choices={shown?.choices ?? {}}
            onChoices={(choices) => setShown({ ...shown, id: tuning.id, choices })}
          />
        </section>
      )}
    </div>
  );
}

interface DiscardProps {
  readonly isPending: boolean;
  readonly onDiscard: () => void;
}

/** Discard what was measured, which cannot be undone, so it asks first. */
function Discard({ isPending, onDiscard }: DiscardProps): JSX.Element {
  const { t } = useTexts();
  const [isAsking, setAsking] = useState(false);
  if (!isAsking) {
    return (
      <Button size="xs" variant="default" onClick={() => setAsking(true)}>
        {t("avatars.tuning.remove")}
      </Button>
    );
  }
  return (
    <>
      <span>{t("avatars.tuning.remove.ask")}</span>
      <Button size="xs" variant="default" autoFocus onClick={() => setAsking(false)}>
        {t("avatars.tuning.remove.keep")}
      </Button>
      <Button size="xs" color="red" loading={isPending} onClick={onDiscard}>
        {t("avatars.tuning.remove.do")}
      </Button>
    </>
  );
}

/** How far it is, in words and as a bar. */
function Course({ tuning }: { readonly tuning: Tuning }): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const { progress, state, trouble } = tuning;
  const axes = tuning.tuned.filter(isTuned);
  if (state !== "tuning" || progress === null) {
    return (
      <p role="status">
        {t(`avatars.tuning.state.${state}`, {
          count: axes.filter(hasGains).length,
          done: axes.filter(({ status }) => status !== "waiting").length,
          total: axes.length,
        })}{" "}
        {trouble}
      </p>
    );
  }
  const words = progress.waiting
    ? t("avatars.tuning.waiting")
    : t(`avatars.tuning.phase.${progress.phase}`, {
        axis: axisName(texts, progress.axis),
        done: progress.done,
        total: progress.total,
        attempt: progress.attempt,
      });
  const percent = progress.total === 0 ? 0 : (100 * progress.done) / progress.total;
  return (
    <>
      <p role="status">{words}</p>
      <Progress value={percent} aria-label={t("avatars.tuning.progress")} />
    </>
  );
}
