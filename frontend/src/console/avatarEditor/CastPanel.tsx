/** Casts: body groups that are held at fixed angles, while their limits are kept for later. */
import { Button, NumberInput } from "@mantine/core";
import { decimals } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useState } from "react";
import { axisName } from "../avatarChanges/axes";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import type { Operation } from "./api";
import { axesOf } from "./axes";
import classes from "./Editor.module.css";
import { DrivenSelect } from "./GroupSelect";
import type { PanelProps } from "./panels";

/** More angle fields than this would bury the button: they are unfolded by those who want them. */
const MAX_FIELDS = 12;

export function CastPanel({ configuration, edit, isReadOnly }: PanelProps): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const [group, setGroup] = useState("LeftHand");
  const whom = { configuration, value: group, onChange: setGroup, isDisabled: isReadOnly };
  const [held, setHeld] = useState<Readonly<Record<string, number | string>>>({});
  const axes = axesOf(configuration, group);
  const isBeyond = (axis: string) => {
    const [angle, settings] = [held[axis], configuration.axes[axis]];
    return (
      typeof angle === "number" &&
      settings !== undefined &&
      (angle < settings.low_deg || angle > settings.high_deg)
    );
  };
  const put = () => {
    if (axes.some(isBeyond)) return;
    const angles = Object.fromEntries(
      axes.flatMap((axis) => (typeof held[axis] === "number" ? [[axis, held[axis]]] : [])),
    );
    const operation = { operation: "lock", group, held_deg: angles } as Operation;
    void edit([operation], t("avatars.did.cast", { name: groupName(texts, group) }));
  };
  const fields = axes.map((axis) => {
    const settings = configuration.axes[axis];
    const range = t("avatars.cast.range", {
      low: decimals(settings?.low_deg ?? 0, language, 0),
      high: decimals(settings?.high_deg ?? 0, language, 0),
    });
    return (
      <NumberInput
        key={axis}
        size="xs"
        label={axisName(texts, axis)}
        description={range}
        error={isBeyond(axis) ? t("avatars.cast.beyond", { range }) : null}
        placeholder="0°"
        suffix="°"
        value={held[axis] ?? ""}
        onChange={(value) => setHeld({ ...held, [axis]: value })}
        hideControls
      />
    );
  });
  return (
    <div className={classes.panels}>
      <fieldset className={classes.panel} disabled={isReadOnly}>
        <legend>{t("avatars.cast.put")}</legend>
        <form
          className={classes.stack}
          onSubmit={(event) => {
            event.preventDefault();
            put();
          }}
        >
          <DrivenSelect {...whom} />
          <p className={classes.soft}>{t("avatars.cast.hint")}</p>
          {axes.length <= MAX_FIELDS ? (
            fields
          ) : (
            <details className={classes.more}>
              <summary>{t("avatars.cast.angles", { count: axes.length })}</summary>
              <div className={classes.stack}>{fields}</div>
            </details>
          )}
          <Button type="submit" size="xs" className={classes.start ?? ""} disabled={isReadOnly}>
            {t("avatars.cast.put")}
          </Button>
        </form>
      </fieldset>
      <div className={classes.stack}>
        <fieldset tabIndex={-1} className={classes.panel} disabled={isReadOnly}>
          <legend>{t("avatars.casts")}</legend>
          {configuration.locked_groups.length === 0 ? (
            <p className={classes.soft}>{t("avatars.cast.none")}</p>
          ) : (
            <ul className={classes.list} aria-label={t("avatars.casts")}>
              {configuration.locked_groups.map((one) => (
                <li key={one}>
                  <Icon name="lock" size={16} />
                  <span>
                    <strong>{groupName(texts, one)}</strong>
                    <span className={classes.soft}>
                      {axesOf(configuration, one)
                        .filter((axis) => configuration.held_deg[axis] !== undefined)
                        .map(
                          (axis) =>
                            `${axisName(texts, axis)} ${decimals(configuration.held_deg[axis] ?? 0, language, 0)}°`,
                        )
                        .join(", ") || t("avatars.cast.tPose")}
                    </span>
                  </span>
                  <RemoveButton
                    label={t("avatars.cast.off")}
                    onRemove={() =>
                      void edit(
                        [{ operation: "unlock", group: one }],
                        t("avatars.did.uncast", { name: groupName(texts, one) }),
                      )
                    }
                  />
                </li>
              ))}
            </ul>
          )}
        </fieldset>
        <Delays configuration={configuration} edit={edit} isReadOnly={isReadOnly} />
      </div>
    </div>
  );
}

interface RemoveButtonProps {
  readonly label: string;
  readonly onRemove: () => void;
}

/** It goes away with what it removes, so the panel around it takes the focus. */
function RemoveButton({ label, onRemove }: RemoveButtonProps): JSX.Element {
  return (
    <Button
      size="compact-xs"
      variant="default"
      onClick={(event) => {
        event.currentTarget.closest("fieldset")?.focus();
        onRemove();
      }}
    >
      {label}
    </Button>
  );
}

/** How much longer single parts lag than the condition says. */
function Delays({ configuration, edit, isReadOnly }: PanelProps): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const [group, setGroup] = useState("left_arm");
  const whom = { configuration, value: group, onChange: setGroup, isDisabled: isReadOnly };
  const [delayMs, setDelayMs] = useState<number | string>("");
  const own = Object.entries(configuration.delays_ms ?? {});
  const set = (target: string, ms: number) =>
    void edit(
      [{ operation: "set_delays", targets: [target], delay_ms: ms }],
      t("avatars.did.delay", { name: groupName(texts, target), ms }),
    );
  return (
    <fieldset tabIndex={-1} className={classes.panel} disabled={isReadOnly}>
      <legend>{t("avatars.delays")}</legend>
      <form
        className={classes.row}
        onSubmit={(event) => {
          event.preventDefault();
          if (typeof delayMs === "number") set(group, delayMs);
        }}
      >
        <DrivenSelect {...whom} />
        <NumberInput
          size="xs"
          w={110}
          label={t("avatars.delay")}
          suffix=" ms"
          placeholder="0 ms"
          value={delayMs}
          onChange={setDelayMs}
          hideControls
        />
        <Button type="submit" size="xs" variant="default" disabled={typeof delayMs !== "number"}>
          {t("avatars.apply")}
        </Button>
      </form>
      <p className={classes.soft}>{t("avatars.delays.hint")}</p>
      {own.length > 0 && (
        <ul className={classes.list} aria-label={t("avatars.delays")}>
          {own.map(([part, ms]) => (
            <li key={part}>
              <Icon name="clock" size={16} />
              <span className="numbers">
                {groupName(texts, part)}: {decimals(ms, language, 0)} ms
              </span>
              <RemoveButton label={t("avatarChanges.remove")} onRemove={() => set(part, 0)} />
            </li>
          ))}
        </ul>
      )}
    </fieldset>
  );
}
