/** The alarms that are on, and which of them the operator has taken note of. */
import type { SessionView } from "@shared/api/types";
import { milliseconds } from "@shared/units";
import { useEffect, useState } from "react";
import { type Quality, type TelemetryStore, useQuality } from "../session/telemetryStore";
import { currentAlarms, NEWS_LAST, type ShownAlarm, type Storage } from "./alarms";

export interface Alarms {
  readonly on: readonly ShownAlarm[];
  readonly quality: Quality | null;
  readonly isSeen: (alarm: ShownAlarm) => boolean;
  readonly see: (alarm: ShownAlarm) => void;
}

export function useAlarms(
  session: SessionView,
  store: TelemetryStore,
  storage: Storage | null,
): Alarms {
  const quality = useQuality(store);
  const [seen, setSeen] = useState<ReadonlySet<string>>(new Set());
  useAgain(quality);
  return {
    on: currentAlarms(session, quality, storage, milliseconds(performance.now())),
    quality,
    isSeen: (alarm) => seen.has(alarm.key),
    see: (alarm) => setSeen((before) => new Set([...before, alarm.key])),
  };
}

/** Draw once more when the news have become old, since nothing else would. */
function useAgain(quality: Quality | null): void {
  const [, again] = useState<Quality | null>(null);
  useEffect(() => {
    const timer = setTimeout(() => again(quality), NEWS_LAST + 50);
    return () => clearTimeout(timer);
  }, [quality]);
}
