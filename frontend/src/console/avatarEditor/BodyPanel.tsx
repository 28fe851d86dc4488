/** Settings of the whole body: its model, mass and relative masses, hips, targets and gravity. */
import { Button, NumberInput, SegmentedControl, Select, Switch } from "@mantine/core";
import { MASS_SHARES, PARTS } from "@shared/avatar/anatomy.generated";
import { decimals } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useState } from "react";
import { groupName } from "../avatarChanges/words";
import { titleOf } from "../bodies/names";
import { bodiesQuery } from "../bodies/queries";
import { type Key, useTexts } from "../i18n";
import { NumbersTable } from "../ui/tables";
import type { Operation } from "./api";
import type { AvatarFile } from "./axes";
import { CompliancePanel } from "./CompliancePanel";
import classes from "./Editor.module.css";
import { drivenGroups, GroupSelect } from "./GroupSelect";
import { Before, Choice, type ComparedPanelProps, type PanelProps } from "./panels";

type Masses = Extract<Operation, { operation: "set_masses" }>;

const POPULATIONS = ["average", "female", "male"] as const;
const HIPS = ["carried", "welded"] as const;
/** The segments that a body has on both sides. */
const PAIRED: readonly string[] = ["Upper arm", "Forearm", "Hand 2", "Thigh", "Shank", "Foot"];
/** What a body can weigh, kg. */
const MASS_KG = [1, 500] as const;
/** The masses that are a click away, kg: the thesis's, and de Leva's mean women and men. */
const PRESETS_KG = [72, 61.9, 73] as const;
/** Whose mean a mass is: relative masses are usually chosen with it. */
const MEANT: Readonly<Record<number, AvatarFile["population"]>> = { 61.9: "female", 73: "male" };
const OWN = "measures";

export function BodyPanel({ base, ...props }: ComparedPanelProps): JSX.Element {
  const { configuration, edit, isReadOnly } = props;
  const { t, language } = useTexts();
  const bodies = useQuery(bodiesQuery);
  const { population, total_mass_kg: totalKg } = configuration;
  const [massKg, setMassKg] = useState<number | string>(totalKg);
  useEffect(() => setMassKg(totalKg), [totalKg]);
  const set = (values: Partial<AvatarFile>, label: string) =>
    void edit([{ operation: "set_body", ...values } as Operation], label);
  const setMasses = (values: Omit<Masses, "operation">, label: string) =>
    void edit([{ operation: "set_masses", ...values }], label);
  const isPossible = typeof massKg === "number" && massKg >= MASS_KG[0] && massKg <= MASS_KG[1];
  const setMass = (kg: number) => {
    // What was typed and refused goes, also where the mass stays as it is.
    setMassKg(kg);
    if (kg !== totalKg) setMasses({ total_mass_kg: kg }, t("avatars.mass"));
  };
  const setTyped = () => isPossible && setMass(massKg);
  const shares = MASS_SHARES[population];
  return (
    <div className={classes.panels}>
      <fieldset className={classes.panel} disabled={isReadOnly}>
        <legend>{t("avatars.masses")}</legend>
        <div className={classes.row}>
          <form
            onSubmit={(event) => {
              event.preventDefault();
              setTyped();
            }}
          >
            <NumberInput
              size="xs"
              w={160}
              label={t("avatars.mass")}
              suffix=" kg"
              clampBehavior="none"
              error={
                isPossible
                  ? null
                  : t("avatars.mass.range", {
                      least: MASS_KG[0],
                      greatest: MASS_KG[1],
                      kg: decimals(totalKg, language, 1),
                    })
              }
              value={massKg}
              onChange={setMassKg}
              onBlur={setTyped}
            />
          </form>
          <fieldset className={classes.presets}>
            <legend className="visually-hidden">{t("avatars.mass.presets")}</legend>
            {PRESETS_KG.map((kg, at) => (
              <button
                key={kg}
                type="button"
                className={classes.plainButton}
                aria-pressed={kg === totalKg}
                onClick={() => setMass(kg)}
              >
                {t(`avatars.mass.preset${at}` as Key, { kg: decimals(kg, language, 1) })}
              </button>
            ))}
          </fieldset>
        </div>
        <Before
          isChanged={base.total_mass_kg !== totalKg}
          value={`${decimals(base.total_mass_kg, language, 1)} kg`}
        />
        <span className={classes.fieldName}>{t("avatars.population")}</span>
        <SegmentedControl
          size="xs"
          aria-label={t("avatars.population")}
          disabled={isReadOnly}
          value={population}
          onChange={(value) =>
            setMasses({ population: value as AvatarFile["population"] }, t("avatars.population"))
          }
          data={POPULATIONS.map((value) => ({ value, label: t(`avatars.population.${value}`) }))}
        />
        <Before
          isChanged={base.population !== population}
          value={t(`avatars.population.${base.population}`)}
        />
        {MEANT[totalKg] !== undefined && MEANT[totalKg] !== population && (
          <p className={classes.soft}>
            {t("avatars.mass.hint", {
              kg: decimals(totalKg, language, 1),
              whom: t(`avatars.population.${MEANT[totalKg]}`),
              whose: t(`avatars.population.${population}`),
            })}
          </p>
        )}
        <p className={classes.soft}>{t("avatars.masses.source")}</p>
        <details className={classes.more}>
          <summary>{t("avatars.masses.bySegment")}</summary>
          <NumbersTable
            label={t("avatars.masses")}
            columns={[t("avatars.segment"), "%", "kg"]}
            rows={[
              ...Object.entries(shares).map(([segment, share]) => [
                t(`avatars.segment.${segment.replaceAll(" ", "_")}` as Key) +
                  (PAIRED.includes(segment) ? t("avatars.segment.each") : ""),
                decimals(100 * share, language, 2),
                decimals(share * totalKg, language, 2),
              ]),
              [t("avatars.total"), decimals(100, language, 2), decimals(totalKg, language, 2)],
            ]}
          />
        </details>
        <OwnShares
          configuration={configuration}
          isReadOnly={isReadOnly}
          onSet={(values) => setMasses(values, t("avatars.shares"))}
        />
      </fieldset>
      <div className={classes.stack}>
        <fieldset className={classes.panel} disabled={isReadOnly}>
          <legend>{t("avatars.worn")}</legend>
          <Select
            size="xs"
            aria-label={t("avatars.worn")}
            disabled={isReadOnly}
            allowDeselect={false}
            value={configuration.humanoid ?? OWN}
            onChange={(value) =>
              value !== null &&
              void edit(
                [{ operation: "set_model", humanoid: value === OWN ? null : value }],
                t("avatars.worn"),
              )
            }
            data={[
              { value: OWN, label: t("avatars.worn.measures") },
              ...(bodies.data?.humanoids ?? []).map((body) => ({
                value: body.content_hash,
                label: titleOf(body),
              })),
            ]}
          />
          <p className={classes.soft}>{t("avatars.worn.hint")}</p>
        </fieldset>
        <fieldset className={classes.panel} disabled={isReadOnly}>
          <legend>{t("avatars.driven")}</legend>
          <Choice
            name="hips"
            value={configuration.hips}
            values={HIPS}
            before={base.hips}
            isReadOnly={isReadOnly}
            onChange={(hips) => set({ hips }, t("avatars.hips"))}
          />
          <Switch
            label={t("avatars.gravity")}
            checked={configuration.gravity}
            onChange={(event) =>
              set({ gravity: event.currentTarget.checked }, t("avatars.gravity"))
            }
          />
        </fieldset>
      </div>
      <CompliancePanel {...props} base={base} />
      <Absent {...props} />
    </div>
  );
}

/** Parts that a model lacks, such as a finger, are taken out with their axes. */
function Absent({ configuration, edit, isReadOnly }: PanelProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const [wished, setPart] = useState<string | null>(null);
  const present = drivenGroups(configuration).filter((group) => group !== "all");
  const part = wished !== null && present.includes(wished) ? wished : null;
  return (
    <form
      className={classes.panel}
      aria-label={t("avatars.absent")}
      onSubmit={(event) => {
        event.preventDefault();
        if (part === null) return;
        const label = t("avatars.did.absent", { name: groupName(texts, part) });
        void edit([{ operation: "remove_parts", targets: [part] }], label);
      }}
    >
      <h3 className={classes.sub}>{t("avatars.absent")}</h3>
      <p className={classes.soft}>{t("avatars.absent.hint")}</p>
      <div className={classes.row}>
        <GroupSelect
          label={t("avatarChanges.group")}
          groups={present}
          value={part}
          onChange={setPart}
          isDisabled={isReadOnly}
        />
        <Button type="submit" size="xs" variant="default" disabled={isReadOnly || part === null}>
          {t("avatars.absent.do")}
        </Button>
      </div>
    </form>
  );
}

interface OwnSharesProps {
  readonly configuration: AvatarFile;
  readonly isReadOnly: boolean;
  readonly onSet: (values: Omit<Masses, "operation">) => void;
}

/** Parts whose share of the mass is not the population's. */
function OwnShares({ configuration, isReadOnly, onSet }: OwnSharesProps): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const [part, setPart] = useState("LeftLowerLeg");
  const [percent, setPercent] = useState<number | string>("");
  const own = Object.entries(configuration.relative_masses_percent ?? {});
  const isReady = typeof percent === "number" && percent > 0 && percent <= 100;
  return (
    <details className={classes.more} open={own.length > 0}>
      <summary>{t("avatars.shares")}</summary>
      <div className={classes.stack}>
        <form
          className={classes.row}
          onSubmit={(event) => {
            event.preventDefault();
            if (isReady) onSet({ percent: { [part]: percent } });
          }}
        >
          <GroupSelect
            label={t("avatars.part")}
            groups={PARTS.map(({ name }) => name)}
            value={part}
            onChange={setPart}
            isDisabled={isReadOnly}
          />
          <NumberInput
            size="xs"
            w={110}
            label={t("avatars.share")}
            suffix=" %"
            value={percent}
            onChange={setPercent}
            hideControls
          />
          <Button type="submit" size="xs" variant="default" disabled={!isReady}>
            {t("avatars.apply")}
          </Button>
        </form>
        <div className={classes.row}>
          <Button size="xs" variant="default" onClick={() => onSet({ distribution: "equal" })}>
            {t("avatars.shares.equal")}
          </Button>
          <Button
            size="xs"
            variant="default"
            disabled={own.length === 0}
            onClick={() => onSet({ distribution: "population" })}
          >
            {t("avatars.shares.population")}
          </Button>
        </div>
        {own.length > 0 && (
          <NumbersTable
            label={t("avatars.shares")}
            className={classes.losses}
            columns={[t("avatars.part"), "%", "kg"]}
            rows={own.map(([name, share]) => [
              groupName(texts, name),
              decimals(share, language, 2),
              decimals((share / 100) * configuration.total_mass_kg, language, 2),
            ])}
          />
        )}
      </div>
    </details>
  );
}
