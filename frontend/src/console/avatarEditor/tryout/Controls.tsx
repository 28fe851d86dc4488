/** What is done to the body: the movement, a push, a box, latency and gravity. */
import { Button, Loader, SegmentedControl, Select, Slider, Switch } from "@mantine/core";
import type { CaptureListed } from "@shared/api/captures";
import { decimals } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { axisName } from "../../avatarChanges/axes";
import { groupName } from "../../avatarChanges/words";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { partOf, SECTIONS, sectionOf } from "../axes";
import { NamedSelect, NumberField } from "./fields";
import { DIRECTIONS, type Direction, OPPOSITES } from "./pulling";
import type { TryoutRun } from "./run";
import {
  AXIS_NAMES,
  type DriveSettings,
  PART_NAMES,
  POSES,
  type PoseName,
  type PushSettings,
  withKind,
} from "./settings";
import classes from "./Tryout.module.css";
import { useFigures } from "./useFigures";

const KINDS = ["hold", "step", "sine"] as const;

interface MovementProps {
  readonly axis: string;
  readonly onAxis: (axis: string) => void;
  readonly limits: { readonly lowDeg: number; readonly highDeg: number };
  readonly drive: DriveSettings;
  readonly onDrive: (drive: DriveSettings) => void;
  readonly pose: PoseName;
  readonly onPose: (pose: PoseName) => void;
  readonly captures: readonly CaptureListed[];
  readonly capture: string | null;
  readonly onCapture: (id: string | null) => void;
  /** The lab has none that could be played. */
  readonly hasNoCaptures: boolean;
  readonly loading: CaptureLoading;
}

/** How far the chosen capture is: the server puts it on the body, which takes some seconds. */
interface CaptureLoading {
  readonly isLoading: boolean;
  readonly error: unknown;
  readonly isUnusable: boolean;
}

function CaptureState({ isLoading, error, isUnusable }: CaptureLoading): JSX.Element | null {
  const { t } = useTexts();
  if (isLoading) {
    return (
      <p role="status" className={classes.loading}>
        <Loader size={14} />
        {t("tryout.capture.loading")}
      </p>
    );
  }
  if (error !== null) return <Failure error={error} />;
  return isUnusable ? <Notice tone="warn" title={t("tryout.capture.unusable")} /> : null;
}

export function Movement(props: MovementProps): JSX.Element {
  const { axis, onAxis, limits, drive, onDrive, captures, capture, onCapture } = props;
  const { pose, onPose } = props;
  const texts = useTexts();
  const { t, language } = texts;
  const deg = (value: number) => `${decimals(value, language, 0)}°`;
  const isLocked = limits.lowDeg === limits.highDeg;
  return (
    <fieldset className={classes.group}>
      <legend>{t("tryout.movement")}</legend>
      <NamedSelect
        label={t("tryout.axis")}
        description={axis}
        data={SECTIONS.map((section) => ({
          group: groupName(texts, section),
          items: AXIS_NAMES.filter((one) => sectionOf(partOf(one)) === section).map((one) => ({
            value: one,
            label: axisName(texts, one),
          })),
        }))}
        value={axis}
        onChange={onAxis}
      />
      {captures.length > 0 && (
        <Select
          size="sm"
          label={t("tryout.capture")}
          placeholder={t("tryout.capture.none")}
          data={captures.map(({ id, title }) => ({ value: id, label: title }))}
          value={capture}
          clearable
          clearButtonProps={{ "aria-label": t("tryout.capture.none") }}
          onChange={onCapture}
        />
      )}
      {props.hasNoCaptures && (
        <p className={classes.keys}>
          {t("tryout.capture.missing")} <a href="#/captures">{t("tryout.capture.add")}</a>
        </p>
      )}
      <CaptureState {...props.loading} />
      {capture === null && (
        <>
          <Select
            size="sm"
            label={t("tryout.pose")}
            data={Object.keys(POSES).map((value) => ({
              value,
              label: t(`tryout.pose.${value as PoseName}`),
            }))}
            value={pose}
            allowDeselect={false}
            onChange={(value) => value !== null && onPose(value as PoseName)}
          />
          <SegmentedControl
            size="xs"
            fullWidth
            aria-label={t("tryout.wave")}
            value={drive.kind}
            onChange={(kind) => onDrive(withKind(drive, kind as DriveSettings["kind"], limits))}
            data={KINDS.map((value) => ({ value, label: t(`tryout.wave.${value}`) }))}
          />
          <div>
            <div className={classes.sliderHead}>
              <span>{t(drive.kind === "hold" ? "tryout.angle" : "tryout.center")}</span>
              <output className="numbers">{deg(drive.angleDeg)}</output>
            </div>
            <Slider
              size="sm"
              thumbLabel={t(drive.kind === "hold" ? "tryout.angle" : "tryout.center")}
              label={null}
              min={Math.ceil(limits.lowDeg)}
              max={Math.floor(limits.highDeg)}
              step={1}
              disabled={isLocked}
              value={drive.angleDeg}
              onChange={(angleDeg) => onDrive({ ...drive, angleDeg })}
            />
            <div className={classes.ends}>
              <span>{deg(limits.lowDeg)}</span>
              <span>{isLocked ? t("tryout.noHinge") : ""}</span>
              <span>{deg(limits.highDeg)}</span>
            </div>
          </div>
          {drive.kind !== "hold" && (
            <div className={classes.pair}>
              <NumberField
                label={t("tryout.amplitude")}
                unit="°"
                range={[0, 180]}
                value={drive.amplitudeDeg}
                onChange={(amplitudeDeg) => onDrive({ ...drive, amplitudeDeg })}
              />
              <NumberField
                label={t("tryout.period")}
                unit="s"
                range={[0.1, 20]}
                step={0.5}
                value={drive.periodS}
                onChange={(periodS) => onDrive({ ...drive, periodS })}
              />
            </div>
          )}
        </>
      )}
    </fieldset>
  );
}

interface DisturbanceProps {
  readonly push: PushSettings;
  readonly onPush: (push: PushSettings) => void;
  readonly go: () => void;
  readonly drop: () => void;
  readonly run: TryoutRun | null;
}

export function Disturbance({ push, onPush, go, drop, run }: DisturbanceProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const stops = useFigures(run, ({ progress }) => progress[0]?.stops ?? null, null);
  const by = stops?.part === push.part ? stops.by : null;
  const stop = by?.[push.direction] ?? null;
  const other = OPPOSITES[push.direction];
  return (
    <fieldset className={classes.group}>
      <legend>{t("tryout.push")}</legend>
      <NamedSelect
        label={t("tryout.push.part")}
        data={PART_NAMES.map((value) => ({ value, label: groupName(texts, value) }))}
        value={push.part}
        onChange={(part) => onPush({ ...push, part })}
      />
      <Select
        size="sm"
        label={t("tryout.push.direction")}
        data={Object.keys(DIRECTIONS).map((value) => ({
          value,
          label: t(`tryout.push.${value as Direction}`),
        }))}
        value={push.direction}
        allowDeselect={false}
        onChange={(value) => value !== null && onPush({ ...push, direction: value as Direction })}
      />
      <div role="status" className={classes.stop}>
        {stop !== null && (
          <>
            <p>{t(`tryout.push.stop.${stop.end}`, { axis: axisName(texts, stop.axis) })}</p>
            {by?.[other] === null && (
              <Button
                size="compact-xs"
                variant="default"
                onClick={() => onPush({ ...push, direction: other })}
              >
                {t("tryout.push.turn", { direction: t(`tryout.push.${other}`) })}
              </Button>
            )}
          </>
        )}
      </div>
      <div className={classes.pair}>
        <NumberField
          label={t("tryout.push.force")}
          unit="N"
          range={[0, 1000]}
          step={50}
          value={push.forceN}
          onChange={(forceN) => onPush({ ...push, forceN })}
        />
        <NumberField
          label={t("tryout.push.for")}
          unit="s"
          range={[0.01, 10]}
          step={0.1}
          value={push.forS}
          onChange={(forS) => onPush({ ...push, forS })}
        />
      </div>
      <div className={classes.pair}>
        <Button size="sm" variant="default" onClick={go}>
          {t("tryout.push.go")}
        </Button>
        <Button size="sm" variant="default" onClick={drop} title={t("tryout.drop.hint")}>
          {t("tryout.drop")}
        </Button>
      </div>
    </fieldset>
  );
}

interface ConditionsProps {
  readonly latencyMs: number;
  readonly longestMs: number;
  readonly onLatency: (latencyMs: number) => void;
  readonly hasGravity: boolean;
  readonly onGravity: (isOn: boolean) => void;
  readonly statureCm: number;
  readonly onStature: (statureCm: number) => void;
  readonly others: readonly { readonly value: string; readonly label: string }[];
  readonly other: string | null;
  readonly onOther: (name: string | null) => void;
}

export function Conditions(props: ConditionsProps): JSX.Element {
  const { latencyMs, longestMs, onLatency, hasGravity, onGravity } = props;
  const { statureCm, onStature, others, other, onOther } = props;
  const { t } = useTexts();
  return (
    <fieldset className={classes.group}>
      <legend className="visually-hidden">{t("tryout.latency")}</legend>
      <div className={classes.pair}>
        <NumberField
          label={t("tryout.latency")}
          unit="ms"
          range={[0, longestMs]}
          step={25}
          value={latencyMs}
          onChange={onLatency}
        />
        <NumberField
          label={t("tryout.stature")}
          unit="cm"
          range={[50, 260]}
          value={statureCm}
          onChange={onStature}
        />
      </div>
      <Switch
        size="sm"
        label={t("tryout.gravity")}
        checked={hasGravity}
        onChange={(event) => onGravity(event.currentTarget.checked)}
      />
      <Select
        size="sm"
        label={t("tryout.compare")}
        placeholder={t("tryout.compare.none")}
        data={others}
        value={other}
        clearable
        clearButtonProps={{ "aria-label": t("tryout.compare.none") }}
        onChange={onOther}
      />
    </fieldset>
  );
}
