/** A consent that waits for the participant's tablet, or is signed on paper instead. */
import {
  Button,
  Chip,
  Group,
  Loader,
  Modal,
  Stack,
  Text,
  Textarea,
  TextInput,
} from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import type { SessionView, Step } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { isConnected } from "../session/action";
import { NewFailure } from "../session/CommandFailure";
import type { useSession } from "../session/useSession";
import classes from "./CurrentStep.module.css";

interface PaperConsentProps {
  readonly session: SessionView;
  readonly step: Step;
  readonly live: ReturnType<typeof useSession>;
}

export function PaperConsent(props: PaperConsentProps): JSX.Element {
  const { t } = useTexts();
  const [opened, dialog] = useDisclosure();
  return (
    <>
      <span className={classes.waiting}>
        <Loader size="sm" type="dots" />
        {t(isConnected(props.session, "tablet") ? "consent.waiting" : "step.noTablet")}
      </span>
      <Button
        variant="default"
        leftSection={<Icon name="document" size={18} />}
        onClick={dialog.open}
      >
        {t("consent.paper.open")}
      </Button>
      <Modal
        opened={opened}
        onClose={dialog.close}
        title={t("consent.paper")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <SheetForm {...props} onClose={dialog.close} />
      </Modal>
    </>
  );
}

const REASONS = ["consent.paper.wish", "consent.paper.broken"] as const;

interface SheetFormProps extends PaperConsentProps {
  readonly onClose: () => void;
}

function SheetForm({ step, live, onClose }: SheetFormProps): JSX.Element {
  const { t } = useTexts();
  const [place, setPlace] = useState("");
  const [reason, setReason] = useState("");
  const sheet = { place: place.trim(), reason: reason.trim() };
  const complete = sheet.place !== "" && sheet.reason !== "";
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (!complete) return;
        live.send({ type: "complete_step", step_index: step.index, paper_consent: sheet }, onClose);
      }}
    >
      <Stack>
        <Text c="dimmed">{t("consent.paper.lead")}</Text>
        <TextInput
          label={t("consent.paper.place")}
          placeholder={t("consent.paper.placeHint")}
          data-autofocus
          maxLength={200}
          value={place}
          onChange={(event) => setPlace(event.currentTarget.value)}
        />
        <Group gap="xs">
          {REASONS.map((key) => (
            <Chip key={key} checked={reason === t(key)} onChange={() => setReason(t(key))}>
              {t(key)}
            </Chip>
          ))}
        </Group>
        <Textarea
          label={t("consent.paper.reason")}
          autosize
          minRows={2}
          maxLength={1000}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
        />
        <NewFailure live={live} />
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" disabled={!complete} loading={live.sending}>
            {t("consent.paper.save")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
