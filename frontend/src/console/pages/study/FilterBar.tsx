/** The filters of the dashboard in a row of fields; every choice is part of the page's address. */
import { Button, MultiSelect, SegmentedControl, Select, TextInput } from "@mantine/core";
import type { Filter, FilterChoices } from "@shared/api/analysis";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "./DashboardTab.module.css";
import { chosenFields, unfiltered } from "./filters";

/** The name of the configuration's body among the choices (`OWN_BODY` in `material.py`). */
const OWN_BODY = "configuration";

interface FilterBarProps {
  readonly filter: Filter;
  readonly choices: FilterChoices;
  readonly onChange: (filter: Filter) => void;
}

export function FilterBar({ filter, choices, onChange }: FilterBarProps): JSX.Element {
  const { t } = useTexts();
  const change = (part: Partial<Filter>): void => onChange({ ...filter, ...part });
  return (
    <fieldset className={classes.filters} aria-label={t("figures.filter")}>
      <MultiSelect
        label={t("figures.participants")}
        placeholder={filter.participant.length === 0 ? t("figures.participants.all") : ""}
        data={[...new Set([...choices.participants, ...filter.participant])]}
        value={[...filter.participant]}
        onChange={(participant) => change({ participant })}
        className={classes.people ?? ""}
        limit={100}
        searchable
        clearable
        size="xs"
      />
      <Select
        label={t("figures.order")}
        placeholder={t("figures.order.all")}
        data={choices.orders.map((value) => ({ value, label: value.replaceAll(" ", " → ") }))}
        value={filter.order}
        onChange={(order) => change({ order })}
        clearable
        size="xs"
      />
      {choices.limbs.length > 1 && (
        <Select
          label={t("figures.limb")}
          placeholder={t("figures.limb.all")}
          data={(["hand", "foot"] as const).map((value) => ({
            value,
            label: t(`figures.limb.${value}`),
          }))}
          value={filter.limb}
          onChange={(limb) => change({ limb: limb === "hand" || limb === "foot" ? limb : null })}
          className={classes.short ?? ""}
          clearable
          size="xs"
        />
      )}
      {choices.bodies.length > 0 && (
        <Select
          label={t("figures.body")}
          data={choices.bodies.map((value) => ({
            value,
            label: value === OWN_BODY ? t("order.configured") : value,
          }))}
          value={filter.body ?? choices.bodies[0] ?? null}
          onChange={(body) => change({ body })}
          className={classes.short ?? ""}
          allowDeselect={false}
          size="xs"
        />
      )}
      {(["since", "until"] as const).map((name) => (
        <TextInput
          key={name}
          type="date"
          label={t(`figures.${name}`)}
          value={filter[name] ?? ""}
          min={choices.first_day ?? ""}
          max={choices.last_day ?? ""}
          onChange={({ currentTarget }) => change({ [name]: currentTarget.value || null })}
          size="xs"
        />
      ))}
      <div>
        <div className={classes.label}>{t("figures.rows")}</div>
        <SegmentedControl
          aria-label={t("figures.rows")}
          size="xs"
          value={filter.rows}
          onChange={(rows) => change({ rows: rows === "all" ? "all" : "valid" })}
          data={(["valid", "all"] as const).map((value) => ({
            value,
            label: t(`figures.rows.${value}`),
          }))}
        />
      </div>
      {chosenFields(filter) > 0 && (
        <Button size="xs" variant="subtle" onClick={() => onChange(unfiltered(filter.kind))}>
          {t("figures.clear")}
        </Button>
      )}
    </fieldset>
  );
}
