/** Order a pilot: simulated people, or the power of the test, from what is assumed. */
import { Button, Checkbox, NumberInput, Select, TextInput, Title } from "@mantine/core";
import { ApiError, type Problem } from "@shared/api/request";
import { duration, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { useMutation } from "@tanstack/react-query";
import { type JSX, type ReactNode, type RefObject, useRef, useState } from "react";
import { Link } from "wouter";
import { replaceText, showLine, YamlField, type YamlText } from "../editor/YamlField";
import { Failure } from "../errors";
import { helpAddress } from "../help/address";
import { useTexts } from "../i18n";
import { Problems } from "../pages/Problems";
import { numbersIn } from "./numbers";
import classes from "./Pilot.module.css";
import { type NewPilot, type Pilot, type PilotDefaults, pilots } from "./pilots";

interface PilotOrderProps {
  readonly studyKey: string;
  readonly defaults: PilotDefaults;
  readonly onStarted: (pilot: Pilot) => unknown;
  readonly onShow: (id: string) => void;
}

const PEOPLE = [1, 1000] as const;
const SETS = [50, 10_000] as const;
const LARGEST_SEED = 2 ** 31 - 1;
const SEEDS = [0, LARGEST_SEED] as const;
const TARGETS = [0.01, 0.99] as const;
const AVATARS = ["physics", "physics_without_fingers", "delayed_copy"] as const;

const isWithin = (value: number | string, [low, high]: readonly [number, number]): boolean =>
  typeof value === "number" && Number.isInteger(value) && value >= low && value <= high;

/** A rough time in whole minutes, or in seconds below one. */
const roughly = (time_s: number): string =>
  duration(seconds(time_s < 60 ? Math.ceil(time_s) : 60 * Math.round(time_s / 60)));

/** Says which whole numbers are valid if a field has none of them; nothing is changed silently. */
function useWholeError(): (
  value: number | string,
  range: readonly [number, number],
) => string | undefined {
  const { t, language } = useTexts();
  return (value, range) => {
    const [low, high] = range.map((end) => number(end, language, 0));
    return isWithin(value, range)
      ? undefined
      : t("pilot.range.whole", { low: low ?? "", high: high ?? "" });
  };
}

export function PilotOrder(props: PilotOrderProps): JSX.Element {
  const { studyKey, defaults, onStarted, onShow } = props;
  const { t } = useTexts();
  const [assumed, setAssumed] = useState(defaults.assumptions ?? "");
  const [isOpen, setOpen] = useState(false);
  const field = useRef<YamlText | null>(null);
  const start = useMutation({
    mutationFn: (order: NewPilot) => pilots.start(studyKey, order),
    onSuccess: onStarted,
  });
  const assumptions = assumed.trim() === "" ? null : assumed;
  const problems = problemsOf(start.error);
  const same = sameAs(start.error);
  const shared = { defaults, assumptions, isPending: start.isPending, onStart: start.mutate };
  const insert = (text: string) => {
    setOpen(true);
    if (field.current !== null) replaceText(field.current.view, text);
  };
  return (
    <div className={classes.order}>
      <div className={classes.both}>
        <CohortForm {...shared} />
        <PowerForm {...shared} onExample={insert} onWrite={() => setOpen(true)} />
      </div>
      <Assumed
        defaults={defaults}
        text={assumed}
        problems={problems}
        field={field}
        isOpen={isOpen || problems.length > 0}
        onOpen={setOpen}
        onText={setAssumed}
        onExample={insert}
      />
      {same !== null && (
        <Notice
          tone="info"
          actions={
            <Button
              size="compact-sm"
              variant="default"
              onClick={() => {
                start.reset();
                onShow(same);
              }}
            >
              {t("pilot.same.show")}
            </Button>
          }
        >
          {t("pilot.same")}
        </Notice>
      )}
      {start.isError && same === null && problems.length === 0 && <Failure error={start.error} />}
    </div>
  );
}

/** The pilot with the same order, because of which another one was refused. */
const sameAs = (refusal: unknown): string | null =>
  refusal instanceof ApiError && refusal.code === "conflict" && typeof refusal.value === "string"
    ? refusal.value
    : null;

const NO_PROBLEMS: readonly Problem[] = [];

/** The problems of the assumptions for which a pilot was refused. */
function problemsOf(refusal: unknown): readonly Problem[] {
  return refusal instanceof ApiError && refusal.code === "invalid_config"
    ? refusal.details
    : NO_PROBLEMS;
}

interface FormProps {
  readonly defaults: PilotDefaults;
  readonly assumptions: string | null;
  readonly isPending: boolean;
  readonly onStart: (order: NewPilot) => void;
}

function CohortForm({ defaults, assumptions, isPending, onStart }: FormProps): JSX.Element {
  const { t } = useTexts();
  const wholeError = useWholeError();
  const [people, setPeople] = useState<number | string>(defaults.participants);
  const [seed, setSeed] = useState<number | string>(1);
  const [avatar, setAvatar] = useState<(typeof AVATARS)[number]>(defaults.avatar);
  const [withPower, setWithPower] = useState(true);
  const isValid = isWithin(people, PEOPLE) && isWithin(seed, SEEDS);
  return (
    <OrderForm
      title={t("pilot.cohort")}
      lead={t("pilot.cohort.lead")}
      isValid={isValid}
      isPending={isPending}
      onSubmit={() =>
        onStart({
          kind: "cohort",
          participants: Number(people),
          seed: Number(seed),
          avatar,
          assumptions: withPower ? assumptions : null,
        })
      }
    >
      <div className={classes.people}>
        <NumberInput
          label={t("pilot.cohort.n")}
          min={PEOPLE[0]}
          max={PEOPLE[1]}
          clampBehavior="none"
          error={wholeError(people, PEOPLE)}
          allowDecimal={false}
          value={people}
          onChange={setPeople}
        />
        <Seed value={seed} onChange={setSeed} />
        <Select
          label={t("pilot.avatar")}
          allowDeselect={false}
          value={avatar}
          onChange={(value) => value !== null && setAvatar(value as typeof avatar)}
          data={AVATARS.map((value) => ({ value, label: t(`pilot.avatar.${value}`) }))}
        />
      </div>
      <Checkbox
        label={t("pilot.withPower")}
        checked={withPower && assumptions !== null}
        disabled={assumptions === null}
        onChange={({ currentTarget }) => setWithPower(currentTarget.checked)}
      />
      {isWithin(people, PEOPLE) && (
        <p className={classes.soft}>
          {t("pilot.estimate", {
            time: roughly(Number(people) * (defaults.person_s[avatar] ?? 0)),
          })}
        </p>
      )}
    </OrderForm>
  );
}

interface PowerFormProps extends FormProps {
  readonly onExample: (text: string) => void;
  readonly onWrite: () => void;
}

function PowerForm(props: PowerFormProps): JSX.Element {
  const { defaults, assumptions, isPending, onStart, onExample, onWrite } = props;
  const { t, language } = useTexts();
  const wholeError = useWholeError();
  const [text, setText] = useState(defaults.numbers.join(", "));
  const [seed, setSeed] = useState<number | string>(1);
  const [sets, setSets] = useState<number | string>(1000);
  const [target, setTarget] = useState<number | string>(0.8);
  const numbers = numbersIn(text);
  const most = defaults.most_participants;
  const isTarget = typeof target === "number" && target >= TARGETS[0] && target <= TARGETS[1];
  const isValid =
    numbers !== null &&
    isWithin(seed, SEEDS) &&
    isWithin(sets, SETS) &&
    isTarget &&
    assumptions !== null;
  return (
    <OrderForm
      title={t("pilot.power")}
      lead={t("pilot.power.lead")}
      missing={
        assumptions === null && (
          <MissingAssumptions example={defaults.example} onExample={onExample} onWrite={onWrite} />
        )
      }
      isValid={isValid}
      isPending={isPending}
      onSubmit={() =>
        numbers !== null &&
        assumptions !== null &&
        onStart({
          kind: "power",
          participants: numbers,
          seed: Number(seed),
          sets: Number(sets),
          target: Number(target),
          assumptions,
        })
      }
    >
      <TextInput
        label={t("pilot.power.n")}
        description={most === null ? t("pilot.power.n.hint") : t("pilot.power.n.most", { most })}
        error={numbers === null ? t("pilot.power.n.wrong") : undefined}
        value={text}
        onChange={({ currentTarget }) => setText(currentTarget.value)}
      />
      <div className={classes.fields}>
        <NumberInput
          label={t("pilot.power.sets")}
          min={SETS[0]}
          max={SETS[1]}
          step={50}
          clampBehavior="none"
          error={wholeError(sets, SETS)}
          allowDecimal={false}
          value={sets}
          onChange={setSets}
        />
        <Seed value={seed} onChange={setSeed} />
        <NumberInput
          label={t("pilot.power.target")}
          min={TARGETS[0]}
          max={TARGETS[1]}
          step={0.05}
          clampBehavior="none"
          decimalSeparator={language === "de" ? "," : "."}
          error={isTarget ? undefined : t("pilot.range.share")}
          value={target}
          onChange={setTarget}
        />
      </div>
    </OrderForm>
  );
}

interface MissingAssumptionsProps {
  readonly example: string | null;
  readonly onExample: (text: string) => void;
  readonly onWrite: () => void;
}

/** What is missing for the start, and the way to it. */
function MissingAssumptions(props: MissingAssumptionsProps): JSX.Element {
  const { example, onExample, onWrite } = props;
  const { t } = useTexts();
  return (
    <>
      <span>{t("pilot.assumptions.missing")}</span>
      <Button
        size="compact-sm"
        variant="default"
        onClick={() => (example === null ? onWrite() : onExample(example))}
      >
        {t(example === null ? "pilot.assumptions.write" : "pilot.assumptions.example")}
      </Button>
    </>
  );
}

interface OrderFormProps {
  readonly title: string;
  readonly lead: string;
  /** What has to be given before the start, beside its button. */
  readonly missing?: ReactNode;
  readonly isValid: boolean;
  readonly isPending: boolean;
  readonly onSubmit: () => void;
  readonly children: ReactNode;
}

function OrderForm(props: OrderFormProps): JSX.Element {
  const { title, lead, missing, isValid, isPending, onSubmit, children } = props;
  const { t } = useTexts();
  return (
    <form
      className={classes.panel}
      aria-label={title}
      onSubmit={(event) => {
        event.preventDefault();
        if (isValid) onSubmit();
      }}
    >
      <Title order={2} size="h3">
        {title}
      </Title>
      <p className={classes.soft}>{lead}</p>
      {children}
      <div className={classes.start}>
        <Button
          type="submit"
          disabled={!isValid}
          loading={isPending}
          leftSection={<Icon name="play" size={16} />}
        >
          {t("pilot.start")}
        </Button>
        {missing}
      </div>
    </form>
  );
}

interface SeedProps {
  readonly value: number | string;
  readonly onChange: (value: number | string) => void;
}

function Seed({ value, onChange }: SeedProps): JSX.Element {
  const { t } = useTexts();
  const wholeError = useWholeError();
  return (
    <NumberInput
      label={t("pilot.seed")}
      title={t("pilot.seed.hint")}
      min={0}
      max={LARGEST_SEED}
      clampBehavior="none"
      error={wholeError(value, SEEDS)}
      allowDecimal={false}
      value={value}
      onChange={onChange}
    />
  );
}

interface AssumedProps {
  readonly defaults: PilotDefaults;
  readonly text: string;
  readonly problems: readonly Problem[];
  readonly field: RefObject<YamlText | null>;
  readonly isOpen: boolean;
  readonly onOpen: (isOpen: boolean) => void;
  readonly onText: (text: string) => void;
  readonly onExample: (text: string) => void;
}

function Assumed(props: AssumedProps): JSX.Element {
  const { defaults, text, problems, field, isOpen, onOpen, onText, onExample } = props;
  const { t } = useTexts();
  const { assumptions, assumptions_trouble, example } = defaults;
  return (
    <details
      className={classes.assumed}
      open={isOpen}
      onToggle={({ currentTarget }) => onOpen(currentTarget.open)}
    >
      <summary>{t("pilot.assumptions")}</summary>
      {assumptions_trouble !== null && (
        <Notice tone="warn">{t("pilot.assumptions.unfit", { why: assumptions_trouble })}</Notice>
      )}
      <p className={classes.soft}>
        {t(text.trim() === "" ? "pilot.assumptions.none" : "pilot.assumptions.hint")}{" "}
        <Link href={helpAddress("pilot", "what-it-assumes")} className={classes.link ?? ""}>
          {t("pilot.assumptions.help")}
        </Link>
      </p>
      {problems.length > 0 && (
        <Problems
          problems={problems}
          onPick={(line) => field.current !== null && showLine(field.current.view, line, true)}
        />
      )}
      <div className={classes.yaml}>
        <YamlField
          initial={assumptions ?? ""}
          label={t("pilot.assumptions.label")}
          problems={problems}
          field={field}
          onChange={onText}
        />
      </div>
      {example !== null && text.trim() === "" && (
        <Button
          size="compact-sm"
          variant="default"
          className={classes.reset ?? ""}
          onClick={() => onExample(example)}
        >
          {t("pilot.assumptions.example")}
        </Button>
      )}
      {assumptions !== null && text !== assumptions && (
        <Button
          size="compact-sm"
          variant="default"
          className={classes.reset ?? ""}
          onClick={() => field.current !== null && replaceText(field.current.view, assumptions)}
        >
          {t("pilot.assumptions.reset")}
        </Button>
      )}
    </details>
  );
}
