/** The simulated bodies: a pointer on a part pulls at it, anywhere else it moves the camera. */
import { Center, Loader, Switch } from "@mantine/core";
import { decimals } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { type JSX, type PointerEvent, type RefObject, useEffect, useRef } from "react";
import { CameraSides } from "../../bodyView/CameraSides";
import { useTexts } from "../../i18n";
import type { Vector } from "./physics/commands";
import { pullOf, strengthOf } from "./pulling";
import type { Grip } from "./scene";
import classes from "./Tryout.module.css";
import { useFigures } from "./useFigures";
import type { Follow } from "./useFollow";
import type { LiveTryout } from "./useTryout";

interface PictureProps {
  readonly root: RefObject<HTMLDivElement | null>;
  readonly live: LiveTryout;
  /** The force of a push by button, whose arrow is shown while it acts. */
  readonly pushedN: Vector;
  readonly follow: Follow;
}

/** A part that is held, and where the pointer was last, px. */
interface Pull {
  readonly grip: Grip;
  xPx: number;
  yPx: number;
}

export function Picture({ root, live, pushedN, follow }: PictureProps): JSX.Element {
  const { t } = useTexts();
  const { run, scene, drawingState, onPicture } = live;
  const label = useRef<HTMLSpanElement>(null);
  const pull = useRef<Pull | null>(null);

  useEffect(() => {
    if (run === null || scene === null) return;
    return onPicture(() => {
      const held = pull.current;
      const row = held?.grip.row ?? 0;
      const at = run.progress[row]?.pushedAtM ?? null;
      let forceN = pushedN;
      if (held !== null) {
        forceN = NOTHING;
        const to = at === null ? null : scene.pointerAt(held.xPx, held.yPx, at, row);
        if (at !== null && to !== null) forceN = pullOf(at, to);
        const { part, pointM } = held.grip;
        run.send({ kind: "push", push: { part, pointM, forceN, forS: null } });
      }
      scene.setForce(forceN, held !== null);
      const words = label.current;
      if (words === null) return;
      words.hidden = at === null || strengthOf(forceN) < 0.5;
      if (at === null || words.hidden) return;
      const [x, y] = scene.onScreen(at, row);
      words.textContent = `${Math.round(strengthOf(forceN))} N`;
      words.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    });
  }, [run, scene, onPicture, pushedN]);

  const placeOf = (event: PointerEvent<HTMLDivElement>): readonly [number, number] => {
    const { left, top } = event.currentTarget.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  const take = (event: PointerEvent<HTMLDivElement>) => {
    const [xPx, yPx] = placeOf(event);
    const grip = event.button === 0 ? (scene?.grip(xPx, yPx) ?? null) : null;
    if (grip === null || run === null || scene === null) return;
    event.stopPropagation();
    event.currentTarget.setPointerCapture(event.pointerId);
    scene.isCameraFree = false;
    pull.current = { grip, xPx, yPx };
    const { part, pointM } = grip;
    run.send({ kind: "push", push: { part, pointM, forceN: NOTHING, forS: null } });
  };
  const release = () => {
    if (pull.current === null) return;
    pull.current = null;
    run?.send({ kind: "push", push: null });
    if (scene !== null) scene.isCameraFree = true;
  };

  return (
    <div className={classes.picture}>
      <div className={classes.sides}>
        <CameraSides onLook={(from) => scene?.placeCamera(from)} />
        <Switch
          size="xs"
          label={t("tryout.follow")}
          checked={follow.isOn}
          onChange={follow.toggle}
        />
        <button type="button" className={classes.view} onClick={() => scene?.resetCamera()}>
          {t("tryout.view")}
        </button>
      </div>
      <div className={classes.stage} data-way={drawingState}>
        <div
          ref={root}
          className={classes.canvas}
          role="img"
          aria-label={t("tryout.picture")}
          onPointerDownCapture={take}
          onPointerMove={(event) => {
            if (pull.current === null) return;
            [pull.current.xPx, pull.current.yPx] = placeOf(event);
          }}
          onPointerUp={release}
          onPointerCancel={release}
        />
        <span ref={label} className={classes.force} hidden />
        <span className={classes.scale}>
          <Distance run={run} scene={scene} />
        </span>
        {drawingState === "loading" && (
          <Center pos="absolute" inset={0}>
            <Loader role="status" aria-label={t("tryout.starting")} />
          </Center>
        )}
        {drawingState === "flat" && (
          <Notice tone="warn" title={t("tryout.flat")} remedy={t("tryout.flat.remedy")} />
        )}
      </div>
    </div>
  );
}

const NOTHING: Vector = [0, 0, 0];

/** What the lines of the floor mean, and how far the body has gone. */
function Distance({
  run,
  scene,
}: {
  readonly run: LiveTryout["run"];
  readonly scene: LiveTryout["scene"];
}): JSX.Element {
  const { t, language } = useTexts();
  const gone = useFigures(run, () => scene?.distanceM ?? 0, 0);
  const words = t("tryout.grid");
  if (gone < GONE_M) return <>{words}</>;
  return <>{`${words} · ${t("tryout.gone", { distance: decimals(gone, language, 1) })}`}</>;
}

/** Nearer than that a body stands where it began. */
const GONE_M = 0.2;
