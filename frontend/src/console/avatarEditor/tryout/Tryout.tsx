/**
 * Try a configuration at once: physics in the page, for what is being edited, before it is saved.
 *
 * The one component that the editor uses; everything else in this folder is its own.
 */
import { Button } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useEffect, useRef, useState } from "react";
import { useTexts } from "../../i18n";
import { Conditions, Disturbance, Movement } from "./Controls";
import { Curves } from "./Curves";
import { Figures } from "./Figures";
import { useKeys } from "./keys";
import { Picture } from "./Picture";
import { Problems, Speed } from "./Status";
import { FIRST_AXIS, limitsOf, partOf } from "./settings";
import type { AvatarFile } from "./source";
import classes from "./Tryout.module.css";
import { useBodies, useOthers } from "./useBodies";
import { useCommands } from "./useCommands";
import { useFollow } from "./useFollow";
import { useRunState } from "./useRunState";
import { useTryout } from "./useTryout";

export interface TryoutProps {
  /** The name of the avatar that is edited. */
  readonly title: string;
  /** The working configuration; a change of it is tried at once. */
  readonly configuration: AvatarFile;
  /** The axis that is chosen elsewhere on the page; null for none. */
  readonly axis: string | null;
  /** Called when another axis is chosen here. */
  readonly onAxis?: (axis: string) => void;
}

const FIRST_STATURE_CM = 175;

export function Tryout({ title, configuration, axis: given, onAxis }: TryoutProps): JSX.Element {
  const { t } = useTexts();
  const [axis, setAxis] = useState(given ?? FIRST_AXIS);
  const [statureCm, setStature] = useState(FIRST_STATURE_CM);
  const [other, setOther] = useState<string | null>(null);
  useEffect(() => {
    if (given !== null) setAxis(given);
  }, [given]);
  const bodies = useBodies(configuration, other, statureCm / 100);
  const others = useOthers();
  const own = t("tryout.own", { title });
  const beside = others.find(({ value }) => value === other)?.label ?? t("tryout.other");
  const names = other === null ? [own] : [own, beside];
  const root = useRef<HTMLDivElement>(null);
  const shown = names.slice(0, bodies.data?.length ?? 1);
  const live = useTryout(root, bodies.data, shown, axis);
  const commands = useCommands(live, configuration, axis, statureCm);
  const { run } = live;
  const state = useRunState(run);
  useEffect(() => live.scene?.choose(partOf(axis)), [live.scene, axis]);
  const choose = (next: string) => {
    setAxis(next);
    onAxis?.(next);
  };
  const follow = useFollow(live.scene);
  useKeys({ run, scene: live.scene, commands, onFollow: follow.toggle });
  return (
    <div className={classes.tryout}>
      <p className={classes.lead}>{t("tryout.lead")}</p>
      <Problems live={live} error={bodies.error} />
      <div className={classes.columns}>
        <div className={classes.controls}>
          <div className={classes.bar}>
            <Button
              size="xs"
              variant="default"
              leftSection={<Icon name={state?.isPlaying === false ? "play" : "pause"} />}
              disabled={run === null}
              onClick={() => run?.play(!run.state.isPlaying)}
            >
              {t(state?.isPlaying === false ? "tryout.play" : "tryout.pause")}
            </Button>
            <Button size="xs" variant="default" disabled={run === null} onClick={() => run?.step()}>
              {t("tryout.step")}
            </Button>
            <Button
              size="xs"
              variant="default"
              disabled={run === null}
              onClick={() => run?.send({ kind: "reset" })}
            >
              {t("tryout.reset")}
            </Button>
            <Speed run={run} />
          </div>
          <div className={classes.watched}>
            <Picture root={root} live={live} pushedN={commands.pushedN} follow={follow} />
            <Curves live={live} axis={axis} names={shown} />
          </div>
          <Figures live={live} names={shown} />
        </div>
        <div className={classes.controls}>
          <Movement
            axis={axis}
            onAxis={choose}
            limits={limitsOf(configuration, axis)}
            {...commands.movement}
          />
          <Disturbance {...commands.disturbance} run={run} />
          <Conditions
            {...commands.conditions}
            statureCm={statureCm}
            onStature={setStature}
            others={others}
            other={other}
            onOther={setOther}
          />
        </div>
      </div>
      <p className={classes.keys}>{t("tryout.keys")}</p>
    </div>
  );
}
