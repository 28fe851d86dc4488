/** Edits several axes at once: the selected ones, a joint, a body group, or the whole body. */
import { Button, NumberInput, Select } from "@mantine/core";
import { type JSX, useState } from "react";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import type { Operation } from "./api";
import { type AvatarFile, FIELDS, type Field, partOf, UNITS } from "./axes";
import classes from "./Editor.module.css";
import { JOINT, ScopeSelect, SELECTION, targetsOf } from "./GroupSelect";
import { resetGroup, setField } from "./operations";

interface TogetherProps {
  readonly configuration: AvatarFile;
  readonly chosen: string | null;
  readonly selected: ReadonlySet<string>;
  readonly onClear: () => void;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
}

const WAYS = ["set", "factor", "locked", "limited", "free", "shipped"] as const;
type Way = (typeof WAYS)[number];

const FACTOR: Partial<Readonly<Record<Field, string>>> = {
  kp_nm_per_rad: "kp_factor",
  kd_nm_s_per_rad: "kd_factor",
  max_torque_nm: "max_torque_factor",
};

/** Only groups and parts can be reset: of an axis, its part. */
const partOrGroup = (target: string): string => (AXIS.test(target) ? partOf(target) : target);
const AXIS = /[a-z][XYZ]$/;

export function Together(props: TogetherProps): JSX.Element {
  const { selected, edit } = props;
  const texts = useTexts();
  const { t } = texts;
  // One number must not overwrite every motor: it begins with the chosen joint.
  const [scope, setScope] = useState<string>(props.chosen === null ? "all" : JOINT);
  const [way, setWay] = useState<Way>("set");
  const [field, setField_] = useState<Field>("kp_nm_per_rad");
  const [value, setValue] = useState<number | string>("");
  const targets = targetsOf(scope, props);
  const name =
    scope === SELECTION && selected.size > 0
      ? t("avatars.several", { count: selected.size })
      : groupName(texts, targets[0] ?? "");
  const needsField = way === "set" || way === "factor";
  const fields = FIELDS.filter((one) => way !== "factor" || FACTOR[one] !== undefined);
  const shownField = fields.includes(field as never) ? field : "kp_nm_per_rad";
  const isReady = !needsField || (typeof value === "number" && Number.isFinite(value));
  const send = () => {
    if (way === "shipped") {
      void edit(
        targets.flatMap((target) => resetGroup(partOrGroup(target))),
        t("avatars.did.motion", { name, motion: t("avatars.way.shipped") }),
      );
      return;
    }
    if (way !== "set" && way !== "factor") {
      const operation = { operation: "set_motion", targets, motion: way } as const;
      void edit([operation], t("avatars.did.motion", { name, motion: t(`avatars.way.${way}`) }));
      return;
    }
    if (typeof value !== "number") return;
    const title = t(`avatars.field.${shownField}`);
    const operations =
      way === "set"
        ? setField(targets, shownField, value)
        : [
            {
              operation: "set_gains",
              targets,
              [FACTOR[shownField] ?? ""]: value,
            } as Operation,
          ];
    void edit(operations, t("avatars.did.field", { name, field: title }));
  };
  return (
    <form
      className={classes.together}
      aria-label={t("avatars.together")}
      onSubmit={(event) => {
        event.preventDefault();
        if (isReady) send();
      }}
    >
      <ScopeSelect label={t("avatars.together")} scope={scope} onScope={setScope} marked={props} />
      <Select
        size="xs"
        label={t("avatars.way")}
        allowDeselect={false}
        value={way}
        onChange={(one) => one !== null && setWay(one as Way)}
        data={WAYS.map((one) => ({ value: one, label: t(`avatars.way.${one}`) }))}
      />
      {needsField && (
        <>
          <Select
            size="xs"
            label={t("avatars.value")}
            allowDeselect={false}
            value={shownField}
            onChange={(one) => one !== null && setField_(one as Field)}
            data={fields.map((one) => ({ value: one, label: t(`avatars.field.${one}`) }))}
          />
          <NumberInput
            size="xs"
            w={110}
            label={way === "factor" ? t("avatars.factor") : UNITS[shownField]}
            value={value}
            onChange={setValue}
            hideControls
          />
        </>
      )}
      <Button type="submit" size="xs" variant="default" disabled={!isReady}>
        {t("avatars.apply")}
      </Button>
      {selected.size > 0 && (
        <Button
          size="xs"
          variant="subtle"
          color="gray"
          onClick={(event) => {
            // The button goes with the selection; the focus stays in the form.
            event.currentTarget.form?.querySelector("input")?.focus();
            props.onClear();
          }}
        >
          {t("avatars.clearSelection")}
        </Button>
      )}
    </form>
  );
}
