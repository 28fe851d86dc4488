/** Choose whom an edit concerns: body groups and parts, and in some places the selected axes. */
import { Select } from "@mantine/core";
import { PARTS } from "@shared/avatar/anatomy.generated";
import type { JSX } from "react";
import { jointName } from "../avatarChanges/axes";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import { type AvatarFile, axesOf, GROUPS, partOf } from "./axes";

/** Every group and every part. */
export const ALL_GROUPS: readonly string[] = [...GROUPS, ...PARTS.map(({ name }) => name)];

/** The groups and parts that have driven axes. */
export const drivenGroups = (configuration: AvatarFile): readonly string[] =>
  ALL_GROUPS.filter((one) => axesOf(configuration, one).length > 0);

interface GroupSelectProps {
  readonly label: string;
  readonly groups: readonly string[];
  readonly value: string | null;
  readonly onChange: (group: string) => void;
  readonly isDisabled: boolean;
}

export function GroupSelect(props: GroupSelectProps): JSX.Element {
  const { label, groups, value, onChange, isDisabled } = props;
  const texts = useTexts();
  return (
    <Select
      size="xs"
      label={label}
      disabled={isDisabled}
      allowDeselect={false}
      searchable
      value={value}
      onChange={(one) => one !== null && onChange(one)}
      data={groups.map((one) => ({ value: one, label: groupName(texts, one) }))}
    />
  );
}

type DrivenSelectProps = Omit<GroupSelectProps, "label" | "groups"> & {
  readonly configuration: AvatarFile;
};

/** A group or part that has driven axes. */
export function DrivenSelect({ configuration, ...props }: DrivenSelectProps): JSX.Element {
  const { t } = useTexts();
  return (
    <GroupSelect {...props} label={t("avatarChanges.group")} groups={drivenGroups(configuration)} />
  );
}

export const SELECTION = "selection";
export const JOINT = "joint";

export interface Marked {
  readonly chosen: string | null;
  readonly selected: ReadonlySet<string>;
}

/** What a scope names, as targets of an operation; without its axes it is the whole body. */
export function targetsOf(scope: string, { chosen, selected }: Marked): readonly string[] {
  if (scope === SELECTION) return selected.size === 0 ? ["all"] : [...selected];
  if (scope === JOINT) return [chosen === null ? "all" : partOf(chosen)];
  return [scope];
}

interface ScopeSelectProps {
  readonly marked: Marked;
  readonly label: string;
  readonly scope: string;
  readonly onScope: (scope: string) => void;
}

/** The selected axes, the chosen joint, or a body group. */
export function ScopeSelect(props: ScopeSelectProps): JSX.Element {
  const { label, scope, onScope } = props;
  const { chosen, selected } = props.marked;
  const texts = useTexts();
  const { t } = texts;
  const several = { value: SELECTION, label: t("avatars.several", { count: selected.size }) };
  const joint =
    chosen === null
      ? []
      : [
          {
            value: JOINT,
            label: t("avatars.thisJoint", { name: jointName(texts, partOf(chosen)) }),
          },
        ];
  const isLost = (scope === SELECTION && selected.size === 0) || (scope === JOINT && !chosen);
  return (
    <Select
      size="xs"
      label={label}
      allowDeselect={false}
      value={isLost ? "all" : scope}
      onChange={(one) => one !== null && onScope(one)}
      data={[
        ...(selected.size > 0 ? [several] : []),
        ...joint,
        ...GROUPS.map((group) => ({ value: group, label: groupName(texts, group) })),
      ]}
    />
  );
}
