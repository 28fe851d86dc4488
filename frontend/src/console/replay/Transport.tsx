/** Play, jump, speed, and the three times of the current moment. */

import { ActionIcon, CopyButton, SegmentedControl, Tooltip } from "@mantine/core";
import { decimals } from "@shared/format";
import { Press } from "@shared/stage/Transport";
import type { Playback } from "@shared/stage/usePlayback";
import { Icon } from "@shared/ui/Icon";
import { type Seconds, seconds } from "@shared/units";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";
import { activeAt, isActive, jumpFrom, wallAt } from "./events";
import { SPEEDS } from "./keys";
import classes from "./Replay.module.css";
import type { Lane } from "./useLane";

interface TransportProps {
  readonly lane: Lane;
  readonly playback: Playback;
  readonly duration: Seconds;
  /** The address of the current moment. */
  readonly link: () => string;
  /** The button that records it. */
  readonly film: ReactNode;
  readonly onHelp: () => void;
}

export function Transport(props: TransportProps): JSX.Element {
  const { lane, playback, duration, link, film, onHelp } = props;
  const { t } = useTexts();
  const jump = (way: -1 | 1) => {
    const to = jumpFrom(lane.all, playback.time, way);
    if (to !== null) playback.seek(seconds(to));
  };
  const play = t(playback.playing ? "replay.pause" : "replay.play");
  return (
    <div className={classes.transport}>
      <div className={classes.buttons}>
        <Press name={t("replay.previous")} icon="back" onClick={() => jump(-1)} />
        <Press
          name={play}
          icon={playback.playing ? "pause" : "play"}
          filled
          onClick={playback.toggle}
        />
        <Press name={t("replay.next")} icon="forward" onClick={() => jump(1)} />
      </div>
      <Times lane={lane} time={playback.time} duration={duration} />
      <div className={classes.buttons}>
        <SegmentedControl
          size="xs"
          aria-label={t("replay.speed")}
          value={String(playback.speed)}
          onChange={(value) => playback.setSpeed(Number(value))}
          data={SPEEDS.map((speed) => ({ value: String(speed), label: `${speed}×` }))}
        />
        {film}
        <CopyLink link={link()} />
        <Tooltip label={t("keys.title")}>
          <ActionIcon variant="default" size="lg" aria-label={t("keys.title")} onClick={onHelp}>
            <Icon name="help" size={18} />
          </ActionIcon>
        </Tooltip>
      </div>
    </div>
  );
}

/** Only as wide as an icon, so a tooltip shows its name and whether the link was copied. */
function CopyLink({ link }: { readonly link: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <CopyButton value={link}>
      {({ copied, copy }) => {
        const name = t(copied ? "replay.linked" : "replay.link");
        return (
          <Tooltip label={name} {...(copied ? { opened: true } : {})}>
            <ActionIcon variant="default" size="lg" aria-label={name} onClick={copy}>
              <Icon name={copied ? "check" : "link"} size={18} />
            </ActionIcon>
          </Tooltip>
        );
      }}
    </CopyButton>
  );
}

interface TimesProps {
  readonly lane: Lane;
  readonly time: Seconds;
  readonly duration: Seconds;
}

function Times({ lane, time, duration }: TimesProps): JSX.Element {
  const { t, language } = useTexts();
  const { replay } = lane;
  const hundredths = (value: number) => decimals(value, language, 2);
  const wall = wallAt(replay, time);
  const clock = new Intl.DateTimeFormat(language === "en" ? "en-GB" : language, {
    hour: "2-digit",
    minute: "2-digit",
    second: "2-digit",
    fractionalSecondDigits: 1,
  });
  const times = [
    ["phase", `${hundredths(time)} / ${hundredths(duration)} s`],
    ["active", `${hundredths(activeAt(replay, time))} s`],
    ["wall", wall === null ? t("replay.time.unknown") : clock.format(wall)],
  ] as const;
  return (
    <dl className={`${classes.times} numbers`} data-time={time.toFixed(3)}>
      {times.map(([name, value]) => (
        <Tooltip key={name} label={t(`replay.time.${name}.hint`)}>
          <div data-standing={name === "active" && !isActive(replay, time)}>
            <dt>{t(`replay.time.${name}`)}</dt>
            <dd>{value}</dd>
          </div>
        </Tooltip>
      ))}
    </dl>
  );
}
