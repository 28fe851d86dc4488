/** One joint of the body and the skeleton's joint assigned to it. */
import { Select } from "@mantine/core";
import type { JointMapView } from "@shared/api/captures";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";
import classes from "./JointMap.module.css";
import { assign } from "./jointMapEdit";
import type { JointMapDraft } from "./useJointMap";

interface JointRowProps {
  readonly joint: string;
  readonly view: JointMapView;
  readonly map: JointMapDraft;
  readonly problem: string | null;
  readonly disabled: boolean;
  readonly isEditing: boolean;
  readonly onFocus: () => void;
}

export function JointRow({
  joint,
  view,
  map,
  problem,
  disabled,
  isEditing,
  onFocus,
}: JointRowProps): JSX.Element {
  const { t } = useTexts();
  const name = t(`joint.${joint}` as Key);
  const played = map.edit.present[joint];
  return (
    <div className={classes.row}>
      <Select
        size="xs"
        label={name}
        classNames={{ root: classes.field ?? "", label: classes.name ?? "" }}
        placeholder={t("map.unmapped")}
        nothingFoundMessage={t("map.nothing")}
        searchable
        clearable
        clearButtonProps={{
          "aria-label": t("map.clear", { joint: name }),
          "aria-hidden": false,
          // Reachable by keyboard only in the row being edited, so that tabbing through the rows
          // stays short.
          tabIndex: isEditing ? 0 : -1,
        }}
        disabled={disabled}
        error={problem}
        data={view.rig_joints}
        value={played ?? null}
        onChange={(chosen) => map.change((edit) => assign(edit, joint, chosen))}
        onFocus={onFocus}
        withScrollArea={false}
        styles={{ options: { maxHeight: 260, overflowY: "auto" } }}
        renderOption={({ option }) => (
          <span style={{ paddingInlineStart: 9 * depthOf(view, option.value) }}>
            {option.label}
          </span>
        )}
      />
      <SourceMark joint={joint} played={played} view={view} />
    </div>
  );
}

/** The depth below the root, by which names are indented to show the hierarchy. */
function depthOf(view: JointMapView, name: string): number {
  let depth = 0;
  let at = view.rig_parents[view.rig_joints.indexOf(name)] ?? -1;
  while (at >= 0) {
    depth += 1;
    at = view.rig_parents[at] ?? -1;
  }
  return depth;
}

interface SourceMarkProps {
  readonly joint: string;
  readonly played: string | undefined;
  readonly view: JointMapView;
}

function SourceMark({ joint, played, view }: SourceMarkProps): JSX.Element {
  const { t } = useTexts();
  if (played === undefined) return <span className={classes.source} />;
  const stored = played === view.joint_map[joint] ? view.sources[joint] : undefined;
  const isProposed = played === view.proposal[joint];
  const source =
    stored === "chosen" || stored === undefined ? (isProposed ? null : "chosen") : stored;
  return (
    <span className={classes.source} data-source={source ?? "proposed"}>
      {source === null ? t("map.source.proposed") : t(`map.source.${source}`)}
    </span>
  );
}
