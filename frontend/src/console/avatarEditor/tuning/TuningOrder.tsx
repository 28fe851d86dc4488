/** Order a tuning: its axes, its rule and its time-out. */
import { Button, Checkbox, NumberInput, Select } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { useFormSubmit } from "../../ui/useSingleSubmit";
import { axesOf } from "../axes";
import classes from "../Editor.module.css";
import { ScopeSelect, targetsOf } from "../GroupSelect";
import { tunedFor } from "./choice";
import type { TuningPanelProps } from "./props";
import { type Tuning, type TuningChoice, tunings } from "./tunings";

interface TuningOrderProps extends TuningPanelProps {
  readonly isBusy: boolean;
  readonly onStarted: (tuning: Tuning) => void;
}

/** The shortest and longest time-out of an axis, in seconds of the simulation. */
const LONGEST_S = [0.01, 600] as const;
const RULES = ["critical", "inertia", "ziegler-nichols-pd", "tyreus-luyben-pd"] as const;

export function TuningOrder(props: TuningOrderProps): JSX.Element {
  const { avatarKey, base, configuration, contentHash, isBusy, onStarted } = props;
  const { t } = useTexts();
  const [scope, setScope] = useState("joint");
  const [rule, setRule] = useState<(typeof RULES)[number]>("critical");
  const [isMirrored, setMirrored] = useState(false);
  const [longestS, setLongestS] = useState<number | string>(10);
  const targets = targetsOf(scope, props);
  const named = targets.flatMap((target) =>
    target in configuration.axes ? [target] : axesOf(configuration, target),
  );
  const tuned = tunedFor(configuration, named, isMirrored);
  const isTimeOut =
    typeof longestS === "number" && longestS >= LONGEST_S[0] && longestS <= LONGEST_S[1];
  const options = (): TuningChoice => ({
    axes: targets[0] === "all" ? null : tuned,
    heuristic: rule,
    mirror: isMirrored,
    attempts: 3,
    accepted_overshoot_percent: 5,
    longest_s: Number(longestS),
    longest_wall_s: 20,
    relay_torques_nm: {},
  });
  const start = useMutation({
    // What is saved is tuned by its name, so that others see it where they open the same avatar.
    mutationFn: () =>
      tunings.start(
        contentHash === base.content_hash
          ? { avatar: { key: avatarKey, version: base.number } }
          : { configuration },
        options(),
      ),
    onSuccess: onStarted,
  });
  const submit = useFormSubmit(start, { isReused: true });
  return (
    <form className={classes.panel} aria-label={t("avatars.tuning.order")} onSubmit={submit}>
      <p className={classes.soft}>{t("avatars.tuning.lead")}</p>
      <div className={classes.row}>
        <ScopeSelect
          label={t("avatars.tuning.axes")}
          scope={scope}
          onScope={setScope}
          marked={props}
        />
        <Select
          size="xs"
          label={t("avatars.tuning.rule")}
          allowDeselect={false}
          value={rule}
          onChange={(value) => value !== null && setRule(value as typeof rule)}
          data={RULES.map((value) => ({ value, label: t(`avatars.tuning.rule.${value}`) }))}
        />
        <NumberInput
          size="xs"
          w={130}
          label={t("avatars.tuning.longest")}
          suffix=" s"
          min={LONGEST_S[0]}
          max={LONGEST_S[1]}
          error={isTimeOut ? null : t("avatars.tuning.longest.valid")}
          value={longestS}
          onChange={setLongestS}
          hideControls
        />
      </div>
      <div className={classes.buttons}>
        <Button
          type="submit"
          size="xs"
          loading={start.isPending}
          disabled={isBusy || tuned.length === 0 || !isTimeOut}
        >
          {t("avatars.tuning.start", { count: tuned.length })}
        </Button>
        <Checkbox
          size="xs"
          label={t("avatars.tuning.mirror")}
          checked={isMirrored}
          onChange={(event) => setMirrored(event.currentTarget.checked)}
        />
      </div>
      {start.isError && <Failure error={start.error} />}
    </form>
  );
}
