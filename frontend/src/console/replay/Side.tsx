/** The panel next to the stage: errors of the moment, events, and answers. */
import { SegmentedControl, Tabs } from "@mantine/core";
import { number } from "@shared/format";
import type { Playback } from "@shared/stage/usePlayback";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { AnswersAfter } from "./AnswersAfter";
import { ErrorMap, NO_ERRORS } from "./ErrorMap";
import { EventList } from "./EventList";
import classes from "./Replay.module.css";
import type { Lane } from "./useLane";

interface SideProps {
  readonly lanes: readonly Lane[];
  /** The index of the phase to show. */
  readonly at: number;
  readonly onAt: (at: number) => void;
  readonly playback: Playback;
}

export function Side({ lanes, at, onAt, playback }: SideProps): JSX.Element {
  const { t, language } = useTexts();
  const [tab, setTab] = useState<string | null>("events");
  const lane = lanes[Math.min(at, lanes.length - 1)] as Lane;
  const { replay, movement } = lane;
  return (
    <aside className={classes.side} aria-label={t("replay.events")}>
      {lanes.length > 1 && (
        <SegmentedControl
          size="xs"
          fullWidth
          orientation="vertical"
          aria-label={t("replay.which")}
          value={String(Math.min(at, lanes.length - 1))}
          onChange={(value) => onAt(Number(value))}
          data={lanes.map(({ label }, index) => ({ value: String(index), label }))}
        />
      )}
      {replay.view === "participant" && (
        <div className={classes.notice}>
          <Notice tone="info" icon="lock" title={t("replay.blind")}>
            {t("replay.blind.body")}
          </Notice>
        </div>
      )}
      {!replay.stature_known && (
        <Notice
          tone="warn"
          title={t("replay.usualBody", { metres: number(replay.stature_m, language) })}
        />
      )}
      {/* Rendered from the start, so that nothing jumps when the movement has loaded. */}
      {replay.view === "full" && replay.has_movement && (
        <ErrorMap errors={movement?.errors ?? NO_ERRORS} time={playback.time} />
      )}
      <Tabs value={tab} onChange={setTab} className={classes.tabs ?? ""} keepMounted={false}>
        <Tabs.List>
          <Tabs.Tab value="events">{t("replay.events")}</Tabs.Tab>
          <Tabs.Tab value="answers">{t("replay.answers")}</Tabs.Tab>
        </Tabs.List>
        <Tabs.Panel value="events" className={classes.panel ?? ""}>
          <EventList all={lane.all} time={playback.time} onSeek={playback.seek} />
        </Tabs.Panel>
        <Tabs.Panel value="answers" className={classes.panel ?? ""}>
          <AnswersAfter replay={replay} />
        </Tabs.Panel>
      </Tabs>
    </aside>
  );
}
