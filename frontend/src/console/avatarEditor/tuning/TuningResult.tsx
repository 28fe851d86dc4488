/** The axes of a tuning: old and new gains, how they respond, and which of them are accepted. */
import { Button, Checkbox } from "@mantine/core";
import { decimals } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery } from "@tanstack/react-query";
import { Fragment, type JSX, useState } from "react";
import { axisName } from "../../avatarChanges/axes";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { differences, UNITS } from "../axes";
import { Differences } from "../Differences";
import classes from "../Editor.module.css";
import { CompareOn } from "./CompareOn";
import {
  type Choices,
  gainsOf,
  hasGains,
  isAccepted,
  isInWork,
  isTuned,
  toPutBack,
  toTake,
  withGainsOf,
} from "./choice";
import { DIGITS } from "./figures";
import type { TuningPanelProps } from "./props";
import own from "./Tuning.module.css";
import { TuningCurves } from "./TuningCurves";
import { type TunedAxis, type Tuning, tunedConfigurationQuery } from "./tunings";

/** A finger is damped by some hundredths of N m s/rad, and tuning changes thousandths of it. */
const DAMPING_DIGITS = 4;

interface TuningResultProps extends TuningPanelProps {
  readonly tuning: Tuning;
  readonly choices: Choices;
  readonly onChoices: (choices: Choices) => void;
}

export function TuningResult(props: TuningResultProps): JSX.Element {
  const { tuning, configuration, choices, onChoices, isReadOnly } = props;
  const { t } = useTexts();
  const rows = tuning.tuned.filter(isTuned);
  const choosable = rows.filter(hasGains);
  const accepted = rows.filter((axis) => isAccepted(axis, choices)).map(({ name }) => name);
  const isReady = tuning.state === "ready";
  const columns = [
    [t("avatars.field.kp_nm_per_rad"), UNITS.kp_nm_per_rad],
    [t("avatars.field.kd_nm_s_per_rad"), UNITS.kd_nm_s_per_rad],
    [t("avatars.tuning.overshoot"), "%"],
    [t("avatars.tuning.settling"), "s"],
  ] as const;
  const chooseAll = (is: boolean) =>
    onChoices(Object.fromEntries(choosable.map(({ name }) => [name, is])));
  return (
    <>
      {isReady && <OtherDifferences {...props} />}
      {isReady && !isReadOnly && (
        <div className={classes.buttons}>
          {([true, false] as const).map((is) => (
            <Button
              key={String(is)}
              size="compact-xs"
              variant="default"
              disabled={accepted.length === (is ? choosable.length : 0)}
              onClick={() => chooseAll(is)}
            >
              {t(is ? "avatars.tuning.acceptAll" : "avatars.tuning.rejectAll")}
            </Button>
          ))}
          <span className={`${classes.soft} numbers`}>
            {t("avatars.tuning.accepted", { count: accepted.length, total: choosable.length })}
          </span>
        </div>
      )}
      <div className={own.scroll}>
        <table className={`${own.figures} numbers`} aria-label={t("avatars.tuning.axes")}>
          <thead>
            <tr>
              {isReady && <th scope="col">{t("avatars.tuning.accept")}</th>}
              <th scope="col">{t("avatars.axis")}</th>
              <th scope="col">{t("avatars.tuning.status")}</th>
              {columns.map(([name, unit]) => (
                <th key={name} scope="col" className={own.figure}>
                  {name} <span className={own.unit}>({unit})</span>
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map((axis) => (
              <Row
                key={axis.name}
                id={tuning.id}
                axis={axis}
                isReady={isReady}
                isReadOnly={isReadOnly}
                isAccepted={isAccepted(axis, choices)}
                isInWork={isReady && isInWork(configuration, axis)}
                onAccept={(is) => onChoices({ ...choices, [axis.name]: is })}
              />
            ))}
          </tbody>
        </table>
      </div>
      {isReady && <TakeOver {...props} />}
      {isReady && <CompareOn tuning={tuning} names={accepted} />}
    </>
  );
}

/** Bring the work in line with what is accepted and rejected. */
function TakeOver({ tuning, choices, configuration, edit, isReadOnly }: TuningResultProps) {
  const { t } = useTexts();
  const take = toTake(configuration, tuning.tuned, choices);
  const back = toPutBack(configuration, tuning.tuned, choices);
  const isDone = take.length === 0 && tuning.tuned.some((axis) => isAccepted(axis, choices));
  const change = useMutation({
    mutationFn: (when: "before" | "after") =>
      when === "after"
        ? edit(gainsOf(take, when), t("avatars.did.tuned", { count: take.length }), "tuned")
        : edit(gainsOf(back, when), t("avatars.did.tunedBack", { count: back.length })),
  });
  if (isReadOnly) return null;
  return (
    <>
      <div className={classes.buttons}>
        {!isDone && (
          <Button
            size="xs"
            disabled={take.length === 0}
            loading={change.isPending}
            onClick={() => change.mutate("after")}
          >
            {t("avatars.tuning.take", { count: take.length })}
          </Button>
        )}
        {back.length > 0 && (
          <Button
            size="xs"
            variant="default"
            loading={change.isPending}
            onClick={() => change.mutate("before")}
          >
            {t("avatars.tuning.back", { count: back.length })}
          </Button>
        )}
        <span role="status">{isDone && t("avatars.tuning.taken")}</span>
      </div>
      {change.isError && <Failure error={change.error} />}
    </>
  );
}

/** What else the work has meanwhile that the tuning did not know. */
function OtherDifferences({ tuning, configuration, contentHash }: TuningResultProps) {
  const { t } = useTexts();
  const isSame = tuning.content_hash === contentHash;
  const tuned = useQuery({ ...tunedConfigurationQuery(tuning.id), enabled: !isSame });
  if (isSame || tuned.data === undefined) return null;
  const before = withGainsOf(configuration, tuned.data);
  const count = differences(before, configuration).length;
  if (count === 0) return null;
  return (
    <Notice tone="warn" title={t("avatars.tuning.differs", { count })}>
      {t("avatars.tuning.differs.means")}
      <Differences
        label={t("avatars.tuning.differs", { count })}
        before={before}
        after={configuration}
        columns={[t("avatars.tuning.differs.tuned"), t("avatars.tuning.differs.work")]}
      />
    </Notice>
  );
}

interface RowProps {
  readonly id: string;
  readonly axis: TunedAxis;
  readonly isReady: boolean;
  readonly isReadOnly: boolean;
  readonly isAccepted: boolean;
  readonly isInWork: boolean;
  readonly onAccept: (isAccepted: boolean) => void;
}

function Row(props: RowProps): JSX.Element {
  const { id, axis, isReady, isReadOnly, isAccepted: isChecked, onAccept } = props;
  const texts = useTexts();
  const { t, language } = texts;
  const [isOpen, setOpen] = useState(false);
  const name = axisName(texts, axis.name);
  const figure = (value: number | null | undefined, digits = DIGITS) =>
    value == null ? "–" : decimals(value, language, digits);
  const words = [
    axis.reason,
    // The note of a mirrored axis says the same by the axis's own name.
    axis.mirrored_from == null
      ? axis.note
      : t("avatars.tuning.copied", { name: axisName(texts, axis.mirrored_from) }),
    axis.warning,
    props.isInWork ? t("avatars.tuning.inWork") : "",
  ].filter((word) => word !== "");
  return (
    <Fragment>
      <tr>
        {isReady && (
          <td>
            <Checkbox
              size="xs"
              aria-label={t("avatars.tuning.acceptOne", { name })}
              disabled={isReadOnly || !hasGains(axis)}
              checked={isChecked}
              onChange={(event) => onAccept(event.currentTarget.checked)}
            />
          </td>
        )}
        <th scope="row">
          {isReady && axis.step != null ? (
            <button
              type="button"
              className={own.axis}
              aria-expanded={isOpen}
              onClick={() => setOpen(!isOpen)}
            >
              {name}
            </button>
          ) : (
            name
          )}
        </th>
        <td>
          {t(`avatars.tuning.status.${axis.status}`)}
          {words.length > 0 && <span className={classes.soft}>{words.join("; ")}</span>}
        </td>
        <td className={own.figure}>
          <Change
            before={figure(axis.kp_before)}
            after={axis.kp == null ? null : figure(axis.kp)}
          />
        </td>
        <td className={own.figure}>
          <Change
            before={figure(axis.kd_before, DAMPING_DIGITS)}
            after={axis.kd == null ? null : figure(axis.kd, DAMPING_DIGITS)}
          />
        </td>
        <td className={own.figure}>{figure(axis.step?.overshoot_percent)}</td>
        <td className={own.figure}>{figure(axis.step?.settling_s)}</td>
      </tr>
      {isOpen && (
        <tr>
          <td colSpan={7}>
            <TuningCurves id={id} axis={axis.name} name={name} />
          </td>
        </tr>
      )}
    </Fragment>
  );
}

interface ChangeProps {
  readonly before: string;
  readonly after: string | null;
}

function Change({ before, after }: ChangeProps): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={own.then}>
      {before}
      {after !== null && (
        <>
          <Icon name="forward" size={12} />
          <span className="visually-hidden">{t("avatars.after")}</span>
          {after}
        </>
      )}
    </span>
  );
}
