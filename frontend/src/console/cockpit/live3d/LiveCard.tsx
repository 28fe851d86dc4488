/** The live movement: avatar and participant among the boxes, which light up when touched. */
import { Button, Loader, SegmentedControl } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import type { PoseTouch } from "@shared/api/poses";
import type { SessionView } from "@shared/api/types";
import { type BodyMarks, NO_MARKS } from "@shared/stage/marks";
import { Icon } from "@shared/ui/Icon";
import { type JSX, type RefObject, useEffect, useRef } from "react";
import { MarksLegend } from "../../avatarChanges/MarksLegend";
import { BodyNotice } from "../../bodyView/BodyNotice";
import { DrawnAs } from "../../bodyView/DrawnAs";
import { type Key, useTexts } from "../../i18n";
import cockpit from "../Cockpit.module.css";
import { isBusy } from "../session/keys";
import type { TelemetryStore } from "../session/telemetryStore";
import { FULL_SCALE_DEG, LEGEND } from "./heat";
import classes from "./Live3d.module.css";
import { type Live, useLiveScene } from "./useLiveScene";
import { VIEW_KEYS, VIEWS, type View } from "./views";

interface LiveCardProps {
  readonly session: SessionView;
  readonly store: TelemetryStore;
  /** What lies over the upper edge of the picture: the scene is drawn below its middle. */
  readonly cover: RefObject<HTMLElement | null>;
}

export function LiveCard({ session, store, cover }: LiveCardProps): JSX.Element {
  const { t } = useTexts();
  const [isShown, setShown] = useLocalStorage({ key: "reembody.cockpit.live", defaultValue: true });
  const [view, setView] = useLocalStorage<View>({
    key: "reembody.cockpit.view",
    defaultValue: "third",
  });
  useViewKeys(isShown, setView);
  return (
    <section className={classes.card} data-tour="live" aria-label={t("live3d.title")}>
      <div className={classes.head}>
        {!isShown && (
          <h2 className={cockpit.sectionTitle} style={{ margin: 0 }}>
            <Icon name="body" size={16} />
            {t("live3d.title")}
          </h2>
        )}
        {session.simulated && <span className={classes.simulated}>{t("live3d.simulated")}</span>}
        {isShown && (
          <SegmentedControl
            size="xs"
            className={classes.views ?? ""}
            aria-label={t("live3d.view")}
            value={view}
            onChange={(value) => setView(value as View)}
            data={VIEWS.map((one) => ({
              value: one,
              label: (
                <>
                  {t(`live3d.view.${one}`)} <kbd className={classes.key}>{VIEW_KEYS[one]}</kbd>
                </>
              ),
            }))}
          />
        )}
        <Button
          size="xs"
          variant="default"
          className={isShown ? "" : (classes.views ?? "")}
          aria-label={t(isShown ? "live3d.hide" : "live3d.show")}
          onClick={() => setShown(!isShown)}
        >
          {t(isShown ? "live3d.hide.short" : "live3d.show.short")}
        </Button>
      </div>
      {isShown && <Picture session={session} store={store} cover={cover} view={view} />}
    </section>
  );
}

interface PictureProps extends LiveCardProps {
  readonly view: View;
}

function Picture({ session, store, cover, view }: PictureProps): JSX.Element {
  const { t } = useTexts();
  const root = useRef<HTMLDivElement>(null);
  const marks = marksOf(session);
  const live = useLiveScene(root, { id: session.id, store, view, marks, cover });
  const isBlinded = live.setup?.blinded ?? true;
  return (
    <>
      <div className={classes.frame} data-way={live.drawingState} data-moving={live.isMoving}>
        <div
          ref={root}
          className={classes.canvas}
          role="img"
          aria-label={t(isBlinded ? "live3d.label.blinded" : "live3d.label")}
        />
        <State session={session} live={live} />
        <BodyNotice body={live.body} instead />
        {!isBlinded && (
          <div className={classes.overlay}>
            <LastTouch touch={inNewestPhase(session, live.last)} />
            <MarksLegend marks={marks} />
            <Legend />
          </div>
        )}
      </div>
      {live.setup !== null && (
        <div className={classes.below}>
          <p className={classes.foot}>
            {t(isBlinded ? "live3d.blinded" : "live3d.figures")}
            {!live.setup.stature_known && ` ${t("live3d.stature")}`}
          </p>
          {live.setup.body != null && <DrawnAs />}
        </div>
      )}
    </>
  );
}

/** Why nothing moves, shown over the picture. */
function State({ session, live }: { readonly session: SessionView; readonly live: Live }) {
  const { t } = useTexts();
  const { drawingState, feed, setup, isMoving } = live;
  if (drawingState === "flat") {
    return (
      <div className={`${classes.state} ${classes.warn}`} role="status">
        <strong>{t("live3d.flat")}</strong>
        <span>{t("live3d.flat.remedy")}</span>
      </div>
    );
  }
  // The page says why beside it, and offers to reload.
  if (drawingState === "unloaded") {
    return <Message text={t("live3d.unloaded")} remedy={t("live3d.unloaded.remedy")} warns />;
  }
  if (drawingState === "loading" || (setup === null && feed !== "lost")) {
    return (
      <div className={classes.state}>
        <Loader size="sm" role="status" aria-label={t("live3d.loading")} />
      </div>
    );
  }
  if (feed === "lost") return <Message text={t("live3d.lost")} warns />;
  if (isMoving) return null;
  const connected = session.devices.some((one) => one.kind === "headset" && one.connected);
  if (setup?.recording !== true) return <Message text={t("live3d.before")} />;
  if (!connected) return <Message text={t("live3d.noHeadset")} warns />;
  return <Message text={t("live3d.none")} remedy={t("live3d.none.remedy")} warns />;
}

interface MessageProps {
  readonly text: string;
  readonly remedy?: string;
  readonly warns?: boolean;
}

function Message({ text, remedy, warns = false }: MessageProps): JSX.Element {
  return (
    <div className={`${classes.state} ${warns ? classes.warn : ""}`}>
      <div className={warns ? classes.warning : classes.message} role="status">
        <strong>
          {warns && <Icon name="alert" size={18} />}
          {text}
        </strong>
        {remedy !== undefined && <span>{remedy}</span>}
      </div>
    </div>
  );
}

function Legend(): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={`${classes.legend} numbers`}>
      {t("live3d.heat")} <span>0°</span>
      <span className={classes.scale} style={{ background: LEGEND }} />
      <span>{t("live3d.heat.most", { degrees: FULL_SCALE_DEG })}</span>
    </span>
  );
}

const marksOf = ({ avatar_changes: changes }: SessionView): BodyMarks =>
  changes == null ? NO_MARKS : { cast: changes.held_parts, passing: changes.passing_parts };

/** Whether there is movement to show: from the moment the participant enters the body. */
export const hasMovement = ({ status, steps }: SessionView): boolean =>
  status === "active" &&
  steps.some((step) => step.kind === "materialise" && step.status !== "pending");

/** 1, 2 and 3 change the view, unless something is being typed or a dialog is open. */
function useViewKeys(isOn: boolean, setView: (view: View) => void): void {
  const latest = useRef(setView);
  useEffect(() => {
    latest.current = setView;
  });
  useEffect(() => {
    if (!isOn) return;
    const onKey = (event: KeyboardEvent) => {
      const view = VIEWS.find((one) => VIEW_KEYS[one] === event.key);
      if (view !== undefined && !isBusy(event)) latest.current(view);
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  }, [isOn]);
}

/** A touch, unless another phase has been prepared since. */
const inNewestPhase = ({ phases }: SessionView, touch: PoseTouch | null): PoseTouch | null =>
  touch?.phase_id === phases.at(-1)?.phase_id ? touch : null;

/** The colours of the boxes in words: the last contact and how it was judged. */
function LastTouch({ touch }: { readonly touch: PoseTouch | null }): JSX.Element {
  const { t } = useTexts();
  if (touch === null) return <span className={classes.last}>{t("live3d.last.none")}</span>;
  if (touch.kind === "completion") {
    return <span className={classes.last}>{t("live3d.completed")}</span>;
  }
  const box = touch.surface?.split("/")[1] ?? "";
  const text = t("live3d.touch", {
    part: (touch.part ?? "").replace(/([a-z])([A-Z])/g, "$1 $2"),
    surface: t(`live3d.surface.${touch.kind}`, { box }),
    effect: t(EFFECTS[touch.effect] ?? "live3d.effect.none"),
  });
  return (
    <span className={classes.last}>
      {t("live3d.last")} <b>{text}</b>
    </span>
  );
}

const EFFECTS: Readonly<Record<string, Key>> = {
  green: "live3d.effect.green",
  target: "live3d.effect.target",
  side: "live3d.effect.side",
  out_of_order: "live3d.effect.out_of_order",
  wrong_part: "live3d.effect.wrong_part",
  early: "live3d.effect.early",
};
