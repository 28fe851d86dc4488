/** Before joints are shown as one per part: what such a joint cannot hold, and what to do about it. */
import { Button, Group, Modal } from "@mantine/core";
import { number } from "@shared/format";
import type { JSX } from "react";
import { axisName } from "../avatarChanges/axes";
import { useTexts } from "../i18n";
import { NumbersTable } from "../ui/tables";
import type { Loss } from "./api";
import { type Field, UNITS } from "./axes";
import classes from "./Editor.module.css";

interface ConvertDialogProps {
  /** Null while the dialog is closed. */
  readonly losses: readonly Loss[] | null;
  readonly isReadOnly: boolean;
  readonly onClose: () => void;
  /** Show one joint per part and keep what it cannot hold. */
  readonly onLook: () => void;
  readonly onConvert: () => void;
}

export function ConvertDialog(props: ConvertDialogProps): JSX.Element {
  const { losses, isReadOnly, onClose, onLook, onConvert } = props;
  const texts = useTexts();
  const { t, language } = texts;
  const value = (one: unknown) =>
    typeof one === "number" ? number(one, language, 3).replace("-", "−") : "–";
  return (
    <Modal
      opened={losses !== null}
      onClose={onClose}
      size="xl"
      title={t("avatars.convert.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <div className={classes.stack}>
        <p>{t("avatars.convert.lead", { count: losses?.length ?? 0 })}</p>
        <NumbersTable
          label={t("avatars.convert.lost")}
          className={classes.losses}
          columns={[
            t("avatars.axis"),
            t("avatars.value"),
            t("avatars.convert.now"),
            t("avatars.convert.then"),
          ]}
          rows={(losses ?? []).map(({ change }) => [
            change.axis === null ? change.path : axisName(texts, change.axis),
            `${t(`avatars.field.${change.field as Field}`)} (${UNITS[change.field as Field]})`,
            value(change.old),
            value(change.new),
          ])}
        />
        <p className={classes.soft}>{t("avatars.convert.rule")}</p>
        <p>{t("avatars.convert.noWayBack")}</p>
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button variant="default" onClick={onConvert} disabled={isReadOnly}>
            {t("avatars.convert.do")}
          </Button>
          <Button onClick={onLook} data-autofocus>
            {t("avatars.convert.look")}
          </Button>
        </Group>
      </div>
    </Modal>
  );
}
