/** Create a session: the next slot of the ledger goes to a participant. */
import {
  Button,
  Group,
  Modal,
  Radio,
  SegmentedControl,
  Stack,
  Text,
  TextInput,
} from "@mantine/core";
import { studies } from "@shared/api/endpoints";
import type { Kind, StudyDetail } from "@shared/api/types";
import { uuid } from "@shared/uuid";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useLocation } from "wouter";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { sessionQuery } from "../../queries";
import { KINDS } from "../../ui/KindFilter";
import { useFormSubmit } from "../../ui/useSingleSubmit";

/** The server's limit; a longer code is rejected with a message instead of being cut. */
const LONGEST_CODE = 40;

interface NewSessionProps {
  readonly study: StudyDetail;
  /** The kind that is chosen at first. */
  readonly firstKind?: Kind;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function NewSession({
  study,
  firstKind = "people",
  opened,
  onClose,
}: NewSessionProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("join.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <JoinForm study={study} firstKind={firstKind} onClose={onClose} />
    </Modal>
  );
}

interface JoinFormProps {
  readonly study: StudyDetail;
  readonly firstKind: Kind;
  readonly onClose: () => void;
}

function JoinForm({ study, firstKind, onClose }: JoinFormProps): JSX.Element {
  const { t, language: spoken } = useTexts();
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  // Chosen once for all tries: if only the answer was lost, the next one gets the same session.
  const [request] = useState(uuid);
  const [code, setCode] = useState("");
  const [kind, setKind] = useState<Kind>(firstKind);
  const [language, setLanguage] = useState(
    study.languages.includes(spoken) ? spoken : (study.languages[0] ?? "en"),
  );
  const join = useMutation({
    mutationFn: () =>
      studies.join(study.key, {
        request_id: request,
        participant_code: code.trim() || null,
        kind,
        language,
      }),
    onSuccess: (session) => {
      queries.setQueryData(sessionQuery(session.id).queryKey, session);
      void queries.invalidateQueries({ queryKey: ["studies"] });
      onClose();
      navigate(`/sessions/${session.id}`);
    },
  });
  const submit = useFormSubmit(join);
  return (
    <form onSubmit={submit}>
      <Stack>
        <TextInput
          label={t("join.code")}
          description={t("join.codeHint")}
          placeholder={t("join.codePlaceholder")}
          data-autofocus
          value={code}
          error={code.trim().length > LONGEST_CODE && t("join.codeTooLong", { most: LONGEST_CODE })}
          onChange={(event) => setCode(event.currentTarget.value)}
        />
        <Radio.Group
          label={t("kind.label")}
          value={kind}
          onChange={(value) => setKind(value as Kind)}
        >
          <Stack gap="xs" mt="xs">
            {KINDS.map((value) => (
              <Radio
                key={value}
                value={value}
                label={t(value === "people" ? "kind.people.one" : `kind.${value}`)}
                description={t(`kind.${value}.hint`)}
                // The explanation is no part of Mantine's label, but people click on it as well.
                wrapperProps={{ onClick: () => setKind(value), style: { cursor: "pointer" } }}
              />
            ))}
          </Stack>
        </Radio.Group>
        <LanguageChoice {...{ study, language }} onChange={setLanguage} />
        {join.isError && <Failure error={join.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" loading={join.isPending}>
            {t("join.submit")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}

interface LanguageChoiceProps {
  readonly study: StudyDetail;
  readonly language: string;
  readonly onChange: (language: string) => void;
}

function LanguageChoice({ study, language, onChange }: LanguageChoiceProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div>
      <Text size="sm" fw={500} mb={4}>
        {t("join.language")}
      </Text>
      <SegmentedControl
        aria-label={t("join.language")}
        value={language}
        onChange={onChange}
        data={study.languages.map((value) => ({
          value,
          label: t(value === "de" ? "language.de" : "language.en"),
        }))}
      />
    </div>
  );
}
