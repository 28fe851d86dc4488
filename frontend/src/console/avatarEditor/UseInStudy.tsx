/** Name a saved version in a study: in the next version of one, or in a new one from a template. */
import { Modal, Select, Stack } from "@mantine/core";
import { drafts } from "@shared/api/drafts";
import { studies } from "@shared/api/endpoints";
import { inLanguage } from "@shared/text";
import { useMutation, useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useLocation } from "wouter";
import { GIVEN_START, storeDraft, storedDraft } from "../editor/keptDraft";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { studiesQuery, templatesQuery } from "../queries";
import { DialogButtons } from "../ui/DialogButtons";
import classes from "./Editor.module.css";

interface UseInStudyProps {
  readonly avatarKey: string;
  readonly title: string;
  /** Null while the dialog is closed. */
  readonly version: number | null;
  /** How many changes of the work are not in any version. */
  readonly unsaved: number;
  readonly onClose: () => void;
}

const STUDY = "study ";
const TEMPLATE = "template ";
/** Where the study editor keeps a new study that was begun elsewhere. */

export function UseInStudy(props: UseInStudyProps): JSX.Element {
  const { avatarKey, title, version, unsaved, onClose } = props;
  const { t, language } = useTexts();
  const [, navigate] = useLocation();
  const [choice, setChoice] = useState<string | null>(null);
  const existing = useQuery(studiesQuery);
  const templates = useQuery(templatesQuery);
  const fromStudies = (existing.data ?? []).map((one) => ({
    value: STUDY + one.key,
    label: inLanguage(one.titles, language),
  }));
  const fromTemplates = (templates.data ?? []).map((one) => ({
    value: TEMPLATE + one.key,
    label: inLanguage(one.title, language),
  }));
  const use = useMutation({
    mutationFn: async (chosen: string) => {
      const isStudy = chosen.startsWith(STUDY);
      const key = chosen.slice((isStudy ? STUDY : TEMPLATE).length);
      const text = isStudy
        ? // Changes of the study that are not saved yet stay.
          (storedDraft(key) ?? (await studies.get(key)).yaml)
        : templates.data?.find((one) => one.key === key)?.yaml;
      const { yaml } = await drafts.edit(text ?? "", [
        { path: ["avatar"], action: "set", value: "physics" },
        { path: ["avatar_configuration"], action: "set", value: { key: avatarKey, version } },
      ]);
      const slot = isStudy ? key : GIVEN_START;
      storeDraft(slot, yaml);
      if (storedDraft(slot) !== yaml) throw new Error(t("avatars.use.notKept"));
      return isStudy ? `/studies/${key}/edit` : "/new/given";
    },
    // The editor shows the field of the avatar first.
    onSuccess: (address) => navigate(address, { state: { shown: "avatar" } }),
  });
  const close = () => {
    use.reset();
    onClose();
  };
  const failed = use.error ?? existing.error ?? templates.error;
  return (
    <Modal
      opened={version !== null}
      onClose={close}
      title={t("avatars.use.title", { title, number: version ?? 0 })}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (choice !== null) use.mutate(choice);
        }}
      >
        <Stack>
          <Select
            data-autofocus
            label={t("avatars.use.where")}
            description={t("avatars.use.hint")}
            placeholder={t("avatars.use.choose")}
            allowDeselect={false}
            value={choice}
            onChange={setChoice}
            data={[
              { group: t("avatars.use.studies"), items: fromStudies },
              { group: t("avatars.use.templates"), items: fromTemplates },
            ]}
          />
          {unsaved > 0 && (
            <p className={classes.soft}>
              {t("avatars.use.unsaved", { count: unsaved, number: version ?? 0 })}
            </p>
          )}
          {failed !== null && <Failure error={failed} />}
          <DialogButtons
            label={t("avatars.use.do")}
            isGrave={false}
            isReady={choice !== null}
            isSending={use.isPending}
            onCancel={close}
          />
        </Stack>
      </form>
    </Modal>
  );
}
