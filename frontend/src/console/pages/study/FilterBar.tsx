/** The filters of the dashboard in a row of fields; every choice is part of the page's address. */
import { Button, MultiSelect, SegmentedControl, Select, TextInput } from "@mantine/core";
import { type Asked, askedOf, type FilterChoices } from "@shared/api/analysis";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "./DashboardTab.module.css";

interface FilterBarProps {
  readonly asked: Asked;
  readonly choices: FilterChoices;
  readonly onChange: (asked: Asked) => void;
}

export function FilterBar({ asked, choices, onChange }: FilterBarProps): JSX.Element {
  const { t } = useTexts();
  const change = (part: Partial<Asked>): void => onChange({ ...asked, ...part });
  const none: Asked = { ...askedOf(new URLSearchParams()), kind: asked.kind };
  return (
    <fieldset className={classes.filters} aria-label={t("figures.filter")}>
      <MultiSelect
        label={t("figures.participants")}
        placeholder={asked.participant.length === 0 ? t("figures.participants.all") : ""}
        data={[...new Set([...choices.participants, ...asked.participant])]}
        value={[...asked.participant]}
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
        value={asked.order}
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
          value={asked.limb}
          onChange={(limb) => change({ limb: limb === "hand" || limb === "foot" ? limb : null })}
          className={classes.short ?? ""}
          clearable
          size="xs"
        />
      )}
      {(["since", "until"] as const).map((name) => (
        <TextInput
          key={name}
          type="date"
          label={t(`figures.${name}`)}
          value={asked[name] ?? ""}
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
          value={asked.rows}
          onChange={(rows) => change({ rows: rows === "all" ? "all" : "valid" })}
          data={(["valid", "all"] as const).map((value) => ({
            value,
            label: t(`figures.rows.${value}`),
          }))}
        />
      </div>
      <Button size="xs" variant="subtle" onClick={() => onChange(none)}>
        {t("figures.clear")}
      </Button>
    </fieldset>
  );
}
