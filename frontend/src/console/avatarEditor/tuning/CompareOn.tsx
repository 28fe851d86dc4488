/** How the body follows a movement with the gains before and with the accepted ones. */
import { Anchor, Button, Loader, SegmentedControl, Select } from "@mantine/core";
import { useInterval } from "@mantine/hooks";
import { decimals } from "@shared/format";
import { useMutation, useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import { Link } from "wouter";
import { axisName } from "../../avatarChanges/axes";
import { groupName } from "../../avatarChanges/words";
import { capturesQuery } from "../../captures/queries";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { byGroup } from "./choice";
import { DIGITS } from "./figures";
import { PairsTable } from "./PairsTable";
import own from "./Tuning.module.css";
import { type Comparison, type Tuning, tunings } from "./tunings";

const WALK = "walk";

interface CompareOnProps {
  readonly tuning: Tuning;
  /** The accepted axes. */
  readonly names: readonly string[];
}

export function CompareOn({ tuning, names }: CompareOnProps): JSX.Element {
  const { t, language } = useTexts();
  const captures = useQuery(capturesQuery);
  const [chosen, setChosen] = useState(WALK);
  const start = useRef<HTMLButtonElement>(null);
  const asking = useRef<AbortController | null>(null);
  const compare = useMutation({
    mutationFn: ({ accepted, capture }: Asked) => {
      asking.current = new AbortController();
      const { signal } = asking.current;
      return tunings.compare(tuning.id, accepted, capture === WALK ? null : capture, signal);
    },
  });
  // Whoever leaves the page does not wait for it.
  useEffect(() => () => asking.current?.abort(), []);
  const cancel = () => {
    asking.current?.abort();
    compare.reset();
    start.current?.focus();
  };
  const listed = captures.data?.captures ?? [];
  const titles = new Map(listed.map(({ id, title }) => [id, title]));
  const asked = compare.variables;
  const titleOf = (capture: string) => titles.get(capture) ?? t("avatars.compareOn.walk");
  return (
    <section className={classes.stack} aria-label={t("avatars.compareOn")}>
      <h3 className={classes.sub}>{t("avatars.compareOn")}</h3>
      <div className={classes.row}>
        <Select
          size="xs"
          aria-label={t("avatars.compareOn")}
          allowDeselect={false}
          value={chosen}
          onChange={(value) => value !== null && setChosen(value)}
          data={[
            { value: WALK, label: t("avatars.compareOn.walk") },
            ...listed.map(({ id, title, has_skeleton }) => ({
              value: id,
              label: has_skeleton ? title : t("avatars.compareOn.noSkeleton", { name: title }),
              disabled: !has_skeleton,
            })),
          ]}
        />
        <Button
          size="xs"
          variant="default"
          disabled={names.length === 0}
          ref={start}
          {...(compare.isPending ? { "data-disabled": true } : {})}
          aria-disabled={compare.isPending}
          onClick={() => !compare.isPending && compare.mutate({ accepted: names, capture: chosen })}
        >
          {t("avatars.compareOn.do")}
        </Button>
        {compare.isPending && <Waiting onCancel={cancel} />}
        {names.length === 0 && (
          <span className={classes.soft}>{t("avatars.compareOn.nothing")}</span>
        )}
      </div>
      {captures.data !== undefined && !listed.some((one) => one.has_skeleton) && (
        <p className={classes.soft}>
          {t("avatars.compareOn.none")}{" "}
          <Anchor component={Link} href="/captures" underline="always" inherit>
            {t("avatars.compareOn.add")}
          </Anchor>
        </p>
      )}
      {compare.isError && <Failure error={compare.error} />}
      {compare.isError && asked !== undefined && asked.capture !== WALK && (
        <Anchor component={Link} href={`/captures/${asked.capture}`} size="sm">
          {t("avatars.compareOn.open")}
        </Anchor>
      )}
      {compare.data !== undefined && asked !== undefined && (
        <>
          <p className={`${classes.soft} numbers`} role="status">
            {t("avatars.compareOn.of", {
              name: titleOf(asked.capture),
              seconds: decimals(compare.data.duration_s, language, DIGITS),
              frames: compare.data.frames,
            })}{" "}
            {asked.accepted.join() !== names.join() && t("avatars.compareOn.stale")}
          </p>
          <Found comparison={compare.data} />
        </>
      )}
    </section>
  );
}

/** How long it has taken so far; the server simulates both bodies, which can take a minute. */
function Waiting({ onCancel }: { readonly onCancel: () => void }): JSX.Element {
  const { t } = useTexts();
  const [began] = useState(() => performance.now());
  const [passedS, setPassed] = useState(0);
  useInterval(() => setPassed(Math.round((performance.now() - began) / 1000)), 1000, {
    autoInvoke: true,
  });
  return (
    <>
      <span className={`${classes.soft} ${own.waiting} numbers`}>
        <Loader size={14} />
        {t("avatars.compareOn.waiting", { seconds: passedS })}
      </span>
      <span role="status" className="visually-hidden">
        {t("avatars.compareOn.simulates")}
      </span>
      <Button size="xs" variant="subtle" color="gray" onClick={onCancel}>
        {t("action.cancel")}
      </Button>
    </>
  );
}

interface Asked {
  readonly accepted: readonly string[];
  readonly capture: string;
}

type By = "group" | "axis";

/** The figures before and after with their differences: of the whole body, then of its parts. */
function Found({ comparison }: { readonly comparison: Comparison }): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const [by, setBy] = useState<By>("group");
  const { before, after } = comparison;
  const figuresOf = (figures: Readonly<Record<string, number>>) =>
    new Map(by === "group" ? byGroup(figures) : Object.entries(figures));
  const [error, errorAfter] = [figuresOf(before.rms_error_deg), figuresOf(after.rms_error_deg)];
  const [torque, torqueAfter] = [figuresOf(before.rms_torque_nm), figuresOf(after.rms_torque_nm)];
  const nameOf = (name: string) =>
    by === "group" ? groupName(texts, name) : axisName(texts, name);
  return (
    <>
      <PairsTable
        label={t("avatars.compareOn.whole")}
        who={t("avatars.compareOn.where")}
        figures={[
          [t("avatars.compareOn.mean"), "°"],
          [t("avatars.compareOn.p95"), "°"],
        ]}
        rows={(["empty", "floor"] as const).map((where) => {
          const [old, next] =
            where === "empty" ? [before, after] : [before.on_floor, after.on_floor];
          return {
            name: t(`avatars.compareOn.${where}`),
            pairs: [
              [old.mean_error_deg, next.mean_error_deg],
              [old.p95_error_deg, next.p95_error_deg],
            ],
          };
        })}
      />
      <div className={classes.row}>
        <h4 className={classes.sub}>{t("avatars.compareOn.each")}</h4>
        <SegmentedControl
          size="xs"
          aria-label={t("avatars.compareOn.each")}
          value={by}
          onChange={(value) => setBy(value as By)}
          data={[
            { value: "group", label: t("avatars.compareOn.byGroup") },
            { value: "axis", label: t("avatars.compareOn.byAxis") },
          ]}
        />
      </div>
      <PairsTable
        label={t("avatars.compareOn.each")}
        who={t(by === "group" ? "avatars.compareOn.group" : "avatars.axis")}
        figures={[
          [t("avatars.compareOn.error"), "°"],
          [t("avatars.compareOn.torque"), "N m"],
        ]}
        rows={[...error.keys()].map((name) => ({
          name: nameOf(name),
          pairs: [
            [error.get(name), errorAfter.get(name)],
            [torque.get(name), torqueAfter.get(name)],
          ],
        }))}
      />
      <p className={classes.soft}>{t("avatars.compareOn.rounded")}</p>
    </>
  );
}
