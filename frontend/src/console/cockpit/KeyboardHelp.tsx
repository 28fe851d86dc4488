import { Modal } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { Key } from "../ui/Key";
import classes from "./Panels.module.css";

interface KeyboardHelpProps {
  readonly opened: boolean;
  readonly onClose: () => void;
}

/** Every key of the cockpit. */
export function KeyboardHelp({ opened, onClose }: KeyboardHelpProps): JSX.Element {
  const { t } = useTexts();
  const keys = [
    [t("keys.enterOrSpace"), t("keys.primary")],
    ["T", t("device.pair.tablet")],
    ["H", t("device.pair.headset")],
    ["P", t("keys.pause")],
    ["N", t("keys.note")],
    ["R", t("keys.redo")],
    ["S", t("keys.skip")],
    ["L", t("keys.log")],
    ["A", t("alarm.open")],
    ["C", t("preflight.open")],
    ["1 2 3", t("live3d.keys")],
    ["?", t("keys.help")],
    ["Esc", t("keys.close")],
  ] as const;
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("keys.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <dl className={classes.keys}>
        {keys.map(([name, meaning]) => (
          <div key={name} style={{ display: "contents" }}>
            <dt>
              <Key name={name} />
            </dt>
            <dd>{meaning}</dd>
          </div>
        ))}
      </dl>
    </Modal>
  );
}
