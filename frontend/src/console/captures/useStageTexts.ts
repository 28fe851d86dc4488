/** The stage's texts in the console's languages. */
import { decimals, number } from "@shared/format";
import type { StageTexts } from "@shared/stage/Stage";
import type { TransportTexts } from "@shared/stage/Transport";
import { useTexts } from "../i18n";

const MAX_NAMES = 4;

export function useStageTexts(): StageTexts {
  const { t, language } = useTexts();
  return {
    loading: t("stage.loading"),
    flat: t("stage.flat"),
    flatRemedy: t("stage.flat.remedy"),
    squares: (metres) => t("stage.squares", { metres: number(metres, language, 4) }),
  };
}

export function useTransportTexts(): TransportTexts {
  const { t, language } = useTexts();
  return {
    play: t("stage.play"),
    pause: t("stage.pause"),
    stepBack: (every) => t(every === 1 ? "stage.back" : "stage.back.every", { every }),
    stepOn: (every) => t(every === 1 ? "stage.on" : "stage.on.every", { every }),
    scrubber: t("stage.scrubber"),
    speed: t("stage.speed"),
    loop: t("stage.loop"),
    time: (now, duration) =>
      t("stage.time", {
        time: decimals(now, language, 2),
        duration: decimals(duration, language, 2),
      }),
    frame: (frame, last, every) =>
      t(every === 1 ? "stage.frame" : "stage.frame.every", { frame, last, every }),
    gaps: t("stage.gaps"),
    unseen: (names) => {
      if (names.length === 0) return t("stage.unseen.none");
      const listed = names.slice(0, MAX_NAMES).join(", ");
      const more = names.length - MAX_NAMES;
      return t("stage.unseen", {
        names: more > 0 ? t("stage.unseen.more", { names: listed, count: more }) : listed,
      });
    },
  };
}
