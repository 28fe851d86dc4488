/** The form of an operator's changes to the avatar; a change during a phase has to be confirmed. */
import {
  ActionIcon,
  Button,
  Checkbox,
  Loader,
  Modal,
  MultiSelect,
  NumberInput,
  SegmentedControl,
  Select,
  Stack,
  Text,
  Textarea,
} from "@mantine/core";
import { sessions } from "@shared/api/endpoints";
import type { AvatarChanges, AvatarChoices, SessionView } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, type KeyboardEvent, type ReactNode, useState } from "react";
import { axisName, isFound } from "../../avatarChanges/axes";
import { groupName, layerName } from "../../avatarChanges/words";
import { type Key, useTexts } from "../../i18n";
import { DialogButtons } from "../../ui/DialogButtons";
import { Loaded } from "../../ui/Loaded";
import { NewFailure } from "../session/CommandFailure";
import type { useSession } from "../session/useSession";
import classes from "./AvatarPanel.module.css";

interface AvatarDialogProps {
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
  readonly opened: boolean;
  /** What the form begins with. */
  readonly prepared: AvatarChanges;
  readonly onClose: () => void;
}

export function AvatarDialog(props: AvatarDialogProps): JSX.Element {
  const { t } = useTexts();
  const { session, opened, onClose } = props;
  const query = useQuery({
    queryKey: ["sessions", session.id, "avatar-choices"],
    queryFn: () => sessions.avatarChoices(session.id),
    enabled: opened,
    staleTime: Number.POSITIVE_INFINITY,
  });
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      size="lg"
      title={t("avatarChanges.dialog")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {opened && (query.isPending ? <Loader size="sm" /> : null)}
      {opened && (
        <Loaded query={query}>{(choices) => <Form {...props} choices={choices} />}</Loaded>
      )}
    </Modal>
  );
}

interface FormProps extends AvatarDialogProps {
  readonly choices: AvatarChoices;
}

function Form({ session, live, prepared, choices, onClose }: FormProps): JSX.Element {
  const { t } = useTexts();
  const [changes, setChanges] = useState<AvatarChanges>(prepared);
  const [reason, setReason] = useState("");
  const [isSure, setSure] = useState(false);
  const isInPhase = session.current !== null && session.current.status !== "ready";
  const set = (part: Partial<AvatarChanges>) => setChanges({ ...changes, ...part });
  const isReady = !isInPhase || isSure;
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (!isReady) return;
        const given = reason.trim() === "" ? {} : { reason: reason.trim() };
        live.send({ type: "change_avatar", avatar_changes: cleaned(changes), ...given }, onClose);
      }}
    >
      <Stack>
        <Text c="dimmed">{t("avatarChanges.dialog.body")}</Text>
        {isInPhase && (
          <Notice tone="warn" title={t("avatarChanges.deviation")}>
            {t("avatarChanges.deviation.body")}
          </Notice>
        )}
        <div className={classes.two}>
          <Choice
            label={t("avatarChanges.gravity")}
            value={changes.gravity}
            onChange={(gravity) => set({ gravity })}
          />
          <Choice
            label={t("avatarChanges.selfCollision")}
            value={changes.self_collision}
            onChange={(self_collision) => set({ self_collision })}
          />
        </div>
        <Casts choices={choices} changes={changes} set={set} />
        {(session.avatar_changes?.study?.casts ?? []).length > 0 && (
          <Released choices={choices} changes={changes} set={set} />
        )}
        <Colliders choices={choices} changes={changes} set={set} />
        <Layers choices={choices} changes={changes} set={set} />
        <Gains choices={choices} changes={changes} set={set} />
        <Textarea
          label={t("avatarChanges.reason")}
          autosize
          minRows={1}
          maxLength={500}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
        />
        {isInPhase && (
          <Checkbox
            label={t("avatarChanges.confirm")}
            checked={isSure}
            onChange={(event) => setSure(event.currentTarget.checked)}
          />
        )}
        <NewFailure live={live} />
        <DialogButtons
          label={t("avatarChanges.save")}
          isGrave={isInPhase}
          isReady={isReady}
          isSending={live.sending}
          onCancel={onClose}
        />
      </Stack>
    </form>
  );
}

/** The changes without empty lists, and without rows in which nothing was chosen. */
function cleaned(changes: AvatarChanges): AvatarChanges {
  const gains = (changes.gains ?? []).filter(
    ({ motors, ...of }) => motors !== "" && Object.values(of).some((one) => one != null),
  );
  const lists = {
    casts: (changes.casts ?? []).filter(({ group }) => group !== ""),
    released: changes.released ?? [],
    colliders: (changes.colliders ?? []).filter(({ group }) => group !== ""),
    layers: changes.layers ?? [],
    gains,
  };
  return {
    ...(changes.gravity == null ? {} : { gravity: changes.gravity }),
    ...(changes.self_collision == null ? {} : { self_collision: changes.self_collision }),
    ...Object.fromEntries(Object.entries(lists).filter(([, list]) => list.length > 0)),
  };
}

interface ChoiceProps {
  readonly label: string;
  readonly value: boolean | null | undefined;
  readonly onChange: (value: boolean | null) => void;
}

function Choice({ label, value, onChange }: ChoiceProps): JSX.Element {
  const { t } = useTexts();
  return (
    <fieldset className={classes.set}>
      <legend>{label}</legend>
      <SegmentedControl
        fullWidth
        size="xs"
        aria-label={label}
        value={value == null ? "study" : value ? "on" : "off"}
        onChange={(one) => onChange(one === "study" ? null : one === "on")}
        data={[
          { value: "study", label: t("avatarChanges.asStudy") },
          { value: "on", label: t("avatarChanges.on") },
          { value: "off", label: t("avatarChanges.off") },
        ]}
      />
    </fieldset>
  );
}

interface PartProps {
  readonly choices: AvatarChoices;
  readonly changes: AvatarChanges;
  readonly set: (part: Partial<AvatarChanges>) => void;
}

interface RowsProps<Row> {
  readonly title: Key;
  readonly hint?: Key;
  readonly rows: readonly Row[];
  readonly blank: Row;
  readonly row: (value: Row, change: (value: Row) => void) => ReactNode;
  readonly className?: string | undefined;
  readonly onChange: (rows: Row[]) => void;
}

/** A list of rows, each with its fields and a button that removes it. */
function Rows<Row>({ title, hint, rows, blank, row, className, onChange }: RowsProps<Row>) {
  const { t } = useTexts();
  return (
    <fieldset className={classes.set}>
      <legend>{t(title)}</legend>
      {hint !== undefined && rows.length > 0 && <p className={classes.hint}>{t(hint)}</p>}
      <div className={classes.rows}>
        {rows.map((value, at) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: a row is identified by its position
          <div key={at} className={className ?? classes.row}>
            {row(value, (next) => onChange(rows.map((one, other) => (other === at ? next : one))))}
            <ActionIcon
              variant="subtle"
              color="gray"
              size="lg"
              aria-label={t("avatarChanges.remove")}
              onClick={() => onChange(rows.filter((_, other) => other !== at))}
            >
              <Icon name="close" size={16} />
            </ActionIcon>
          </div>
        ))}
      </div>
      <Button
        mt={rows.length > 0 ? 6 : 0}
        size="compact-xs"
        variant="subtle"
        leftSection={<Icon name="add" size={14} />}
        onClick={() => onChange([...rows, blank])}
      >
        {t("avatarChanges.add")}
      </Button>
    </fieldset>
  );
}

interface GroupSelectProps {
  readonly groups: readonly string[];
  readonly value: string;
  readonly onChange: (group: string) => void;
}

function GroupSelect({ groups, value, onChange }: GroupSelectProps): JSX.Element {
  const texts = useTexts();
  return (
    <Select
      size="xs"
      aria-label={texts.t("avatarChanges.group")}
      placeholder={texts.t("avatarChanges.group")}
      searchable
      selectFirstOptionOnChange
      allowDeselect={false}
      onKeyDownCapture={chooseShown}
      data={groups.map((one) => ({ value: one, label: groupName(texts, one) }))}
      value={value === "" ? null : value}
      onChange={(one) => one !== null && onChange(one)}
    />
  );
}

/**
 * Enter takes the option that is shown as chosen. Mantine forgets it by a timer that it sets when
 * the list opens, so that a quick Enter would send the form without it.
 */
function chooseShown(event: KeyboardEvent<HTMLInputElement>): void {
  if (event.key !== "Enter" || event.nativeEvent.isComposing) return;
  const list = document.getElementById(event.currentTarget.getAttribute("aria-controls") ?? "");
  const shown = list?.querySelector<HTMLElement>("[data-combobox-selected]");
  if (shown == null) return;
  event.preventDefault();
  event.stopPropagation();
  shown.click();
}

function Casts({ choices, changes, set }: PartProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const axes = choices.axes.map(({ axis }) => ({ value: axis, label: axisName(texts, axis) }));
  return (
    <Rows
      title="avatarChanges.casts"
      hint="avatarChanges.casts.hint"
      rows={changes.casts ?? []}
      blank={{ group: "" }}
      onChange={(casts) => set({ casts })}
      row={(cast, change) => (
        <>
          <GroupSelect
            groups={choices.driven}
            value={cast.group}
            onChange={(group) => change({ group })}
          />
          <div className={classes.rows}>
            {Object.entries(cast.held_deg ?? {}).map(([axis, angle]) => (
              <NumberInput
                key={axis}
                size="xs"
                label={axisName(texts, axis)}
                aria-label={t("avatarChanges.angle", { axis: axisName(texts, axis) })}
                suffix="°"
                value={angle}
                {...limitsOf(choices, axis)}
                onChange={(value) =>
                  change({ ...cast, held_deg: { ...cast.held_deg, [axis]: Number(value) } })
                }
              />
            ))}
            <Select
              size="xs"
              aria-label={t("avatarChanges.angle.add")}
              placeholder={t("avatarChanges.angle.add")}
              searchable
              data={axes}
              filter={({ search }) =>
                axes.filter(({ label, value }) => isFound(search, label, value))
              }
              renderOption={({ option }) => (
                <div>
                  {option.label}
                  <Text size="xs" c="dimmed">
                    {option.value}
                  </Text>
                </div>
              )}
              value={null}
              onChange={(axis) =>
                axis !== null && change({ ...cast, held_deg: { ...cast.held_deg, [axis]: 0 } })
              }
            />
          </div>
        </>
      )}
    />
  );
}

function limitsOf({ axes }: AvatarChoices, axis: string): { min?: number; max?: number } {
  const found = axes.find((one) => one.axis === axis);
  return found === undefined ? {} : { min: found.low_deg, max: found.high_deg };
}

function Released({ choices, changes, set }: PartProps): JSX.Element {
  const texts = useTexts();
  return (
    <MultiSelect
      size="xs"
      label={texts.t("avatarChanges.released")}
      description={texts.t("avatarChanges.released.hint")}
      searchable
      data={choices.driven.map((one) => ({ value: one, label: groupName(texts, one) }))}
      value={[...(changes.released ?? [])]}
      onChange={(released) => set({ released })}
    />
  );
}

function Colliders({ choices, changes, set }: PartProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Rows
      title="avatarChanges.colliders"
      rows={changes.colliders ?? []}
      blank={{ group: "", kind: "none" as const }}
      onChange={(colliders) => set({ colliders })}
      row={(one, change) => (
        <>
          <GroupSelect
            groups={choices.groups}
            value={one.group}
            onChange={(group) => change({ ...one, group })}
          />
          <SegmentedControl
            size="xs"
            aria-label={t("avatarChanges.kind")}
            value={one.kind}
            onChange={(kind) => change({ ...one, kind: kind as typeof one.kind })}
            data={choices.kinds.map((kind) => ({
              value: kind,
              label: t(`avatarChanges.kind.${kind}`),
            }))}
          />
        </>
      )}
    />
  );
}

function Layers({ choices, changes, set }: PartProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const first = choices.layers.find(({ collide }) => collide);
  return (
    <Rows
      title="avatarChanges.layers"
      rows={changes.layers ?? []}
      blank={{ layers: first?.layers ?? ["left_hand", "torso"], collide: false }}
      onChange={(layers) => set({ layers })}
      row={(one, change) => (
        <>
          <Select
            size="xs"
            aria-label={t("avatarChanges.pair")}
            searchable
            allowDeselect={false}
            data={choices.layers.map(({ layers }) => ({
              value: layers.join("+"),
              label: layers.map((layer) => layerName(texts, layer)).join(" · "),
            }))}
            value={[...one.layers].sort().join("+")}
            onChange={(value) => {
              const pair = choices.layers.find(({ layers }) => layers.join("+") === value);
              if (pair !== undefined) change({ ...one, layers: pair.layers });
            }}
          />
          <SegmentedControl
            size="xs"
            aria-label={t("avatarChanges.selfCollision")}
            value={one.collide ? "on" : "off"}
            onChange={(value) => change({ ...one, collide: value === "on" })}
            data={[
              { value: "on", label: t("avatarChanges.on") },
              { value: "off", label: t("avatarChanges.off") },
            ]}
          />
        </>
      )}
    />
  );
}

const FACTORS = [
  ["kp_factor", "avatarChanges.factor.kp"],
  ["kd_factor", "avatarChanges.factor.kd"],
  ["max_torque_factor", "avatarChanges.factor.torque"],
] as const;

function Gains({ choices, changes, set }: PartProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Rows
      title="avatarChanges.gains"
      className={classes.gain}
      rows={changes.gains ?? []}
      blank={{ motors: "" }}
      onChange={(gains) => set({ gains })}
      row={(one, change) => (
        <>
          <GroupSelect
            groups={choices.driven}
            value={one.motors}
            onChange={(motors) => change({ ...one, motors })}
          />
          {FACTORS.map(([name, label]) => (
            <NumberInput
              key={name}
              size="xs"
              label={t(label)}
              min={0}
              max={choices.greatest_factor}
              step={0.1}
              decimalScale={3}
              placeholder="1"
              value={one[name] ?? ""}
              onChange={(value) => change({ ...one, [name]: value === "" ? null : Number(value) })}
            />
          ))}
        </>
      )}
    />
  );
}
