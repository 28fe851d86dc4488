/** Record the replay as a video while it plays, from the current moment to its end or until stopped. */
import { ActionIcon, Button, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { saveFile } from "@shared/saveFile";
import type { Playback } from "@shared/stage/usePlayback";
import { Icon } from "@shared/ui/Icon";
import { seconds } from "@shared/units";
import { type JSX, type RefObject, useEffect, useRef, useState } from "react";
import { useTexts } from "../i18n";
import { endingOf, type Film, type FilmColours, type FilmWords, filmType, startFilm } from "./film";

interface FilmButtonProps {
  /** Whether there is a picture to record. */
  readonly isReady: boolean;
  /** The element around the stages, whose canvases are recorded. */
  readonly stages: RefObject<HTMLElement | null>;
  readonly playback: Playback;
  readonly duration: number;
  readonly words: Omit<FilmWords, "time">;
  /** The name of the file without its ending. */
  readonly name: string;
}

const TYPE = filmType();

export function FilmButton(props: FilmButtonProps): JSX.Element {
  const { isReady, stages, playback, duration } = props;
  const { t } = useTexts();
  const film = useRef<Film | null>(null);
  const [isOn, setOn] = useState(false);
  const latest = useRef(props);
  useEffect(() => {
    latest.current = props;
  });
  useEffect(() => () => film.current?.cancel(), []);
  const fail = () => {
    film.current?.cancel();
    film.current = null;
    setOn(false);
    notifications.show({ color: "red", message: t("replay.film.failed") });
  };
  const finish = async (): Promise<void> => {
    const made = film.current;
    film.current = null;
    setOn(false);
    if (made === null || TYPE === null) return;
    try {
      const address = URL.createObjectURL(await made.stop());
      saveFile(address, `${latest.current.name}.${endingOf(TYPE)}`);
      setTimeout(() => URL.revokeObjectURL(address), 60_000);
      notifications.show({ message: t("replay.film.saved") });
    } catch {
      fail();
    }
  };
  const { playing, time } = playback;
  const isOver = time >= duration;
  // Its end ends the film; a pause of the replay is not in it.
  const end = useRef(finish);
  end.current = finish;
  useEffect(() => {
    if (!isOn) return;
    if (playing) film.current?.resume();
    else if (isOver) void end.current();
    else film.current?.pause();
  }, [isOn, playing, isOver]);
  const begin = () => {
    const root = stages.current;
    if (root === null || TYPE === null) return;
    const words = (): FilmWords => ({
      ...latest.current.words,
      time: `${latest.current.playback.time.toFixed(2)} s`,
    });
    try {
      film.current = startFilm([...root.querySelectorAll("canvas")], TYPE, coloursOf(root), words);
    } catch {
      return fail();
    }
    if (isOver) playback.seek(seconds(0));
    if (!playing) playback.toggle();
    setOn(true);
  };
  if (isOn) {
    return (
      <Button
        size="xs"
        h={34}
        color="red"
        leftSection={<Icon name="stop" size={18} />}
        onClick={() => {
          if (playing) playback.toggle();
          void finish();
        }}
      >
        {t("replay.film.stop")}
      </Button>
    );
  }
  const title = t(TYPE === null ? "replay.film.cannot" : "replay.film");
  const isOff = TYPE === null || !isReady;
  return (
    <Tooltip label={title}>
      <ActionIcon
        variant="default"
        size="lg"
        aria-label={title}
        // Named and reachable all the same, so that it can say why.
        aria-disabled={isOff}
        {...(isOff ? { "data-disabled": true } : {})}
        onClick={() => {
          if (!isOff) begin();
        }}
      >
        <Icon name="film" size={18} />
      </ActionIcon>
    </Tooltip>
  );
}

function coloursOf(element: HTMLElement): FilmColours {
  const style = getComputedStyle(element);
  const token = (name: string): string => style.getPropertyValue(name).trim();
  return {
    ground: token("--surface"),
    ink: token("--ink"),
    soft: token("--ink-soft"),
    mark: token("--sim"),
    font: style.fontFamily,
  };
}
