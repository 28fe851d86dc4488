/** Before a file replaces the work: what it changes, beside what is not saved yet. */
import { Button, Group, Modal } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { type AvatarFile, differences } from "./axes";
import { Differences } from "./Differences";
import classes from "./Editor.module.css";

/** A file that was read and found to be a configuration. */
export interface ReadFile {
  readonly name: string;
  readonly configuration: AvatarFile;
}

interface ImportDialogProps {
  /** Null while the dialog is closed. */
  readonly file: ReadFile | null;
  readonly configuration: AvatarFile;
  /** How many changes of the work are not saved. */
  readonly unsaved: number;
  readonly onClose: () => void;
  readonly onReplace: (file: ReadFile) => void;
}

export function ImportDialog(props: ImportDialogProps): JSX.Element {
  const { file, configuration, unsaved, onClose, onReplace } = props;
  const { t } = useTexts();
  const count = file === null ? 0 : differences(configuration, file.configuration).length;
  return (
    <Modal
      opened={file !== null}
      onClose={onClose}
      size="xl"
      title={t("avatars.did.file", { name: file?.name ?? "" })}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {file !== null && (
        <div className={classes.stack}>
          <p>{count === 0 ? t("avatars.import.same") : t("avatars.import.lead", { count })}</p>
          {count > 0 && unsaved > 0 && <p>{t("avatars.import.unsaved", { count: unsaved })}</p>}
          <Differences
            label={t("avatars.compare")}
            before={configuration}
            after={file.configuration}
            columns={[t("avatars.yourWork"), t("avatars.import.inFile")]}
          />
          <Group justify="flex-end">
            <Button variant="default" onClick={onClose} data-autofocus>
              {t(count === 0 ? "action.close" : "action.cancel")}
            </Button>
            {count > 0 && <Button onClick={() => onReplace(file)}>{t("avatars.import.do")}</Button>}
          </Group>
        </div>
      )}
    </Modal>
  );
}
