/** The table of joints: by body group, one row for each axis, or for each part of a template. */
import { SegmentedControl, TextInput } from "@mantine/core";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useMemo, useState } from "react";
import { axisName, isFound, jointName } from "../avatarChanges/axes";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import type { JointView, Operation } from "./api";
import {
  type AvatarFile,
  complianceOf,
  FIELDS,
  FILTERS,
  type Field,
  type Filter,
  isCast,
  isLocked,
  partOf,
  passes,
  RANGES,
  SECTIONS,
  STIFF,
  sectionOf,
  UNITS,
} from "./axes";
import { DampingHint } from "./DampingHint";
import classes from "./Editor.module.css";
import { type GridRow, type GridSection, NumberGrid } from "./NumberGrid";
import { setField, setJointField } from "./operations";
import { SINGLE_COLUMNS, singleCells } from "./singleJoints";
import { Together } from "./Together";

export type View = "axes" | "parts";

interface JointTableProps {
  readonly configuration: AvatarFile;
  readonly base: AvatarFile;
  readonly joints: Readonly<Record<string, JointView>>;
  /** The joints of `base`; undefined until they are known. */
  readonly baseJoints: Readonly<Record<string, JointView>> | undefined;
  readonly view: View;
  readonly onView: (view: View) => void;
  readonly chosen: string | null;
  readonly onChoose: (axis: string) => void;
  readonly selected: ReadonlySet<string>;
  readonly onSelected: (selected: ReadonlySet<string>) => void;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
  readonly isReadOnly: boolean;
  /** Open the setting that lets a group give way. */
  readonly onCompliance: () => void;
}

const DIGITS = 3;

export function JointTable(props: JointTableProps): JSX.Element {
  const { configuration, base, joints, baseJoints, view, selected, chosen, isReadOnly, edit } =
    props;
  const texts = useTexts();
  const { t, language } = texts;
  const [search, setSearch] = useState("");
  const [filter, setFilter] = useState<Filter>("all");
  const [opened, setOpened] = useState<ReadonlySet<string>>(new Set(["left_leg"]));
  const isNarrowed = search.trim() !== "" || filter !== "all";
  const sections = useMemo(() => {
    const wanted = Object.keys(configuration.axes).filter(
      (axis) =>
        passes(filter, configuration, base, axis) &&
        (search.trim() === "" || isFound(search.trim(), axisName(texts, axis), axis)),
    );
    const softness = complianceOf(configuration);
    return SECTIONS.flatMap((section): GridSection[] => {
      const axes = wanted.filter((axis) => sectionOf(partOf(axis)) === section);
      const rows =
        view === "axes"
          ? axes.map((axis) => axisRow(axis, configuration, base, texts))
          : [...new Set(axes.map(partOf))].flatMap((part) =>
              partRow(part, joints, baseJoints, texts),
            );
      if (rows.length === 0 && isNarrowed) return [];
      const isChanged = ({ cells }: GridRow) => cells.some((cell) => cell?.before !== undefined);
      const changed = rows.filter(isChanged).length;
      const words = [
        t(view === "axes" ? "avatars.count.axes" : "avatars.count.joints", { count: rows.length }),
      ];
      if (changed > 0) words.push(t("avatars.count.changed", { count: changed }));
      const percent = softness[section].stiffness_percent;
      if (percent !== STIFF.stiffness_percent) {
        words.push(t("avatars.count.soft", { percent: number(percent, language, 4) }));
      }
      return [{ key: section, title: groupName(texts, section), summary: words.join(" · "), rows }];
    });
  }, [
    configuration,
    base,
    joints,
    baseJoints,
    view,
    filter,
    search,
    isNarrowed,
    texts,
    t,
    language,
  ]);
  const open = isNarrowed ? new Set(sections.map(({ key }) => key)) : opened;
  const columns =
    view === "axes"
      ? FIELDS.map((key) => ({
          key,
          title: t(`avatars.field.${key}`),
          unit: UNITS[key],
          range: RANGES[key],
        }))
      : SINGLE_COLUMNS.map((column) => ({ ...column, title: t(column.title) }));
  const rowsOfSelection = (row: string) => (selected.has(row) ? [...selected] : [row]);
  return (
    <div className={classes.tableCard}>
      <div className={classes.tools}>
        <TextInput
          size="xs"
          type="search"
          aria-label={t("avatars.search")}
          placeholder={t("avatars.search")}
          leftSection={<Icon name="search" size={14} />}
          value={search}
          onChange={(event) => setSearch(event.currentTarget.value)}
          className={classes.search ?? ""}
        />
        <SegmentedControl
          size="xs"
          aria-label={t("avatars.filter")}
          value={filter}
          onChange={(value) => setFilter(value as Filter)}
          data={FILTERS.map((value) => ({ value, label: t(`avatars.filter.${value}`) }))}
        />
        <SegmentedControl
          size="xs"
          aria-label={t("avatars.view")}
          value={view}
          onChange={(value) => props.onView(value as View)}
          data={[
            { value: "axes", label: t("avatars.view.axes") },
            { value: "parts", label: t("avatars.view.parts") },
          ]}
        />
        <button
          type="button"
          className={classes.plainButton}
          onClick={() => setOpened(opened.size === 0 ? new Set(SECTIONS) : new Set())}
        >
          {t(opened.size === 0 ? "avatars.openAll" : "avatars.closeAll")}
        </button>
      </div>
      <div className={classes.scroll}>
        {sections.length === 0 ? (
          <p className={classes.nothing}>{t("avatars.nothing")}</p>
        ) : (
          <NumberGrid
            label={t("avatars.table")}
            columns={columns}
            sections={sections}
            open={open}
            onOpen={(section, isOpen) => {
              const next = new Set(opened);
              if (isOpen) next.add(section);
              else next.delete(section);
              setOpened(next);
            }}
            selected={selected}
            onSelect={(rows, isSelected) => {
              const next = new Set(selected);
              for (const row of rows) {
                if (isSelected) next.add(row);
                else next.delete(row);
              }
              props.onSelected(next);
            }}
            chosen={rowOf(chosen, view, configuration)}
            onChoose={props.onChoose}
            onEdit={(row, column, value) => {
              const rows = rowsOfSelection(row);
              const name = rows.length === 1 ? row : t("avatars.several", { count: rows.length });
              const title = columns.find(({ key }) => key === column)?.title ?? column;
              void edit(
                view === "axes"
                  ? setField(rows, column as Field, value)
                  : setJointField(rows, column, value),
                t("avatars.did.field", { name, field: title }),
              );
            }}
            isReadOnly={isReadOnly}
            format={(value) => number(value, language, DIGITS).replace("-", "−")}
            texts={{
              name: t(view === "axes" ? "avatars.axis" : "avatars.joint"),
              selection: t("avatars.selection"),
              select: (name) => t("avatars.select", { name }),
              was: (value) => t("avatars.was", { value }),
              wrong: ({ unit, range: [least, greatest] }) =>
                t("avatars.notNumber", {
                  least: number(least, language, 0).replace("-", "−"),
                  greatest: number(greatest, language, 0),
                  unit,
                }),
            }}
          />
        )}
      </div>
      {!isReadOnly && view === "axes" && (
        <DampingHint
          base={base}
          configuration={configuration}
          edit={edit}
          onCompliance={props.onCompliance}
        />
      )}
      {!isReadOnly && view === "axes" && (
        <Together
          configuration={configuration}
          chosen={chosen}
          selected={selected}
          onClear={() => props.onSelected(new Set())}
          edit={edit}
        />
      )}
    </div>
  );
}

/** The row of the chosen axis or part: of an axis its part, of a part its first axis. */
function rowOf(chosen: string | null, view: View, configuration: AvatarFile): string | null {
  if (chosen === null) return null;
  const isAxis = chosen in configuration.axes;
  if (view === "parts") return isAxis ? partOf(chosen) : chosen;
  if (isAxis) return chosen;
  return Object.keys(configuration.axes).find((axis) => partOf(axis) === chosen) ?? null;
}

type Texts = ReturnType<typeof useTexts>;

function axisRow(axis: string, configuration: AvatarFile, base: AvatarFile, texts: Texts): GridRow {
  const { t } = texts;
  const settings = configuration.axes[axis];
  const name = axisName(texts, axis);
  const tags = [
    ...(isCast(configuration, axis) ? [t("avatars.tag.cast")] : []),
    ...(settings !== undefined && isLocked(settings) ? [t("avatars.tag.locked")] : []),
  ];
  const cells = FIELDS.map((field) => {
    const value = settings?.[field] ?? 0;
    const before = base.axes[axis]?.[field];
    const label = `${name}, ${t(`avatars.field.${field}`)}`;
    return { value, label, before: before === value ? undefined : before };
  });
  return { key: axis, name, code: axis, tags, cells };
}

function partRow(
  part: string,
  joints: Readonly<Record<string, JointView>>,
  baseJoints: Readonly<Record<string, JointView>> | undefined,
  texts: Texts,
): GridRow[] {
  const joint = joints[part];
  if (joint === undefined) return [];
  const old = baseJoints?.[part];
  const before = old === undefined ? [] : singleCells(old);
  const name = jointName(texts, part);
  const cells = singleCells(joint).map((cell, at) => {
    const column = SINGLE_COLUMNS[at];
    if (cell === null || column === undefined) return null;
    const was = before[at] ?? undefined;
    const label = `${name}, ${texts.t(column.title)}`;
    return { value: cell, label, before: was === cell ? undefined : was };
  });
  return [{ key: part, name, code: part, tags: [joint.primary_axis.slice(-1)], cells }];
}
