import { Modal } from "@mantine/core";
import type { JSX } from "react";
import panels from "../cockpit/Panels.module.css";
import { useTexts } from "../i18n";
import { Key } from "../ui/Key";
import classes from "./Replay.module.css";

interface ReplayKeysProps {
  readonly opened: boolean;
  readonly onClose: () => void;
}

/** Every key of the replay. */
export function ReplayKeys({ opened, onClose }: ReplayKeysProps): JSX.Element {
  const { t } = useTexts();
  const keys = [
    [[t("replay.key.space"), "K"], t("replay.keys.play")],
    [["←", "→"], t("replay.keys.second")],
    [[",", "."], t("replay.keys.frame")],
    [["J", "L", "[", "]"], t("replay.keys.event")],
    [["Home", "End"], t("replay.keys.ends")],
    [["−", "+"], t("replay.keys.speed")],
    [["C"], t("replay.keys.camera")],
    [["?"], t("keys.help")],
  ] as const;
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("keys.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <dl className={panels.keys}>
        {keys.map(([names, meaning]) => (
          <div key={names.join(" ")} style={{ display: "contents" }}>
            <dt className={classes.keyNames}>
              {names.map((name) => (
                <Key key={name} name={name} />
              ))}
            </dt>
            <dd>{meaning}</dd>
          </div>
        ))}
      </dl>
    </Modal>
  );
}
