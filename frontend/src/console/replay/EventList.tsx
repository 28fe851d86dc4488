/** All events in order; the list follows the time, and each entry leads to its moment. */
import { decimals, number } from "@shared/format";
import { BLOCK_COLOURS } from "@shared/stage/figure";
import { type Seconds, seconds } from "@shared/units";
import { type CSSProperties, type JSX, memo, useEffect, useRef } from "react";
import { type Key, useTexts } from "../i18n";
import { causeKey } from "../steps";
import { latestEventAt, type ReplayEvent, type Touch, toneOf } from "./events";
import classes from "./Replay.module.css";

interface EventListProps {
  readonly all: readonly ReplayEvent[];
  readonly time: Seconds;
  readonly onSeek: (time: Seconds) => void;
}

export function EventList({ all, time, onSeek }: EventListProps): JSX.Element {
  const { t } = useTexts();
  const list = useRef<HTMLOListElement>(null);
  const at = latestEventAt(all, time);
  // Scroll only the list, never the page.
  useEffect(() => {
    const box = list.current;
    const row = box?.children[Math.max(at, 0)];
    if (!(box && row instanceof HTMLElement)) return;
    const top = row.offsetTop - box.offsetTop;
    if (top < box.scrollTop + ROW_PX || top > box.scrollTop + box.clientHeight - 2 * ROW_PX) {
      box.scrollTop = top - box.clientHeight / 2;
    }
  }, [at]);
  if (all.length === 0) return <p className={classes.soft}>{t("replay.events.none")}</p>;
  return (
    <ol ref={list} className={classes.events}>
      {all.map((one, index) => (
        <Row key={one.key} one={one} current={index === at} onSeek={onSeek} />
      ))}
    </ol>
  );
}

const ROW_PX = 34;

interface RowProps {
  readonly one: ReplayEvent;
  readonly current: boolean;
  readonly onSeek: (time: Seconds) => void;
}

const Row = memo(function Row({ one, current, onSeek }: RowProps): JSX.Element {
  const { language } = useTexts();
  const { title, detail } = useWords(one);
  const tone = one.kind === "touch" ? toneOf(one) : one.kind;
  const colour = tone in BLOCK_COLOURS ? BLOCK_COLOURS[tone as keyof typeof BLOCK_COLOURS] : "";
  return (
    <li>
      <button
        type="button"
        className={classes.event}
        data-tone={tone}
        data-moment
        aria-current={current ? "time" : undefined}
        style={{ "--tone": colour } as CSSProperties}
        onClick={() => onSeek(seconds(one.time))}
      >
        <span className={`${classes.when} numbers`}>{decimals(one.time, language, 1)}</span>
        <span className={classes.dot} aria-hidden="true" />
        <span className={classes.what}>
          {title}
          {detail !== "" && <span className={classes.detail}>{detail}</span>}
        </span>
      </button>
    </li>
  );
});

interface Words {
  readonly title: string;
  readonly detail: string;
}

function useWords(one: ReplayEvent): Words {
  const { t, language } = useTexts();
  switch (one.kind) {
    case "clock": {
      const cause = causeKey(one.cause);
      return {
        title: t(`replay.clock.${one.what}`),
        detail: cause === null ? "" : t(cause),
      };
    }
    case "done":
      return {
        title: t("replay.done", { number: one.number }),
        detail: t("replay.done.detail", { time: number(one.duration, language, 1) }),
      };
    case "note":
      return {
        title: one.text,
        detail: `${t("replay.note.by")} · ${one.by.replace(/^account:/, "")}`,
      };
    case "touch":
      return {
        title: touchTitle(one, t),
        detail: [
          ...(EFFECTS.has(one.effect) ? [t(`replay.effect.${one.effect}` as Key)] : []),
          one.parts.map(partName).join(", "),
          `${number(one.end - one.time, language, 2)} s`,
        ].join(" · "),
      };
  }
}

const EFFECTS = new Set(["green", "out_of_order", "wrong_part", "early"]);

function touchTitle(one: Touch, t: ReturnType<typeof useTexts>["t"]): string {
  if (one.surfaceKind === "panel") return t("replay.touch.panel", { box: one.box ?? "" });
  if (one.surfaceKind === "target" || one.surfaceKind === "start") {
    return t(`replay.touch.${one.surfaceKind}`);
  }
  return t("replay.touch.side", {
    box: one.box ?? "",
    side: one.side === null ? "" : t(`replay.side.${one.side}` as Key),
  });
}

/** `LeftLowerArm` as `left lower arm`: the names are those of the record. */
const partName = (part: string): string => part.replace(/([a-z])([A-Z])/g, "$1 $2").toLowerCase();
