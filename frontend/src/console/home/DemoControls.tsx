/** How far the demo lab is in words and as a bar, and the button that removes it. */
import { Button, Modal, Progress } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { notifications } from "@mantine/notifications";
import type { Demo } from "@shared/api/housekeeping";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { DialogButtons } from "../ui/DialogButtons";
import { useLoadDemo, useRemoveDemo } from "./demo";
import classes from "./Home.module.css";

/** The words; `all` is said once everybody has finished. */
export function DemoStatus({
  demo,
  all,
}: {
  readonly demo: Demo;
  readonly all: string;
}): JSX.Element {
  const { t } = useTexts();
  const counts = { completed: demo.completed, planned: demo.people };
  return (
    <span role="status">
      {demo.state === "loading"
        ? t("demo.finished", counts)
        : demo.state === "failed"
          ? t("demo.failed", { message: demo.message ?? "" })
          : demo.state === "stopped"
            ? t("demo.stopped", counts)
            : all}
    </span>
  );
}

/** While they are on their way. */
export function DemoProgress({ demo }: { readonly demo: Demo }): JSX.Element | null {
  const { t } = useTexts();
  if (demo.state !== "loading") return null;
  return (
    <Progress
      className={classes.loadingBar ?? ""}
      value={(100 * demo.completed) / Math.max(1, demo.people)}
      aria-label={t("demo.finished", { completed: demo.completed, planned: demo.people })}
    />
  );
}

/** Goes on with those who are missing. */
export function LoadRest({ demo }: { readonly demo: Demo }): JSX.Element | null {
  const { t } = useTexts();
  const load = useLoadDemo();
  if (demo.state !== "stopped" && demo.state !== "failed") return null;
  return (
    <>
      <Button
        size="compact-xs"
        variant="default"
        loading={load.isPending}
        onClick={() => load.mutate()}
      >
        {t("demo.more")}
      </Button>
      {load.isError && <Failure error={load.error} />}
    </>
  );
}

/** Removes it, after a question. */
export function RemoveDemo(): JSX.Element {
  const { t } = useTexts();
  const [asking, ask] = useDisclosure();
  return (
    <>
      <Button size="compact-xs" variant="subtle" color="gray" onClick={ask.open}>
        {t("demo.remove")}
      </Button>
      <RemoveDialog opened={asking} onClose={ask.close} />
    </>
  );
}

function RemoveDialog({
  opened,
  onClose,
}: {
  readonly opened: boolean;
  readonly onClose: () => void;
}): JSX.Element {
  const { t } = useTexts();
  const remove = useRemoveDemo();
  const submit = () =>
    remove.mutate(undefined, {
      onSuccess: () => {
        onClose();
        notifications.show({ message: t("demo.removed") });
      },
    });
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("demo.remove.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <form
        onSubmit={(event) => {
          event.preventDefault();
          submit();
        }}
      >
        <p>{t("demo.remove.body")}</p>
        {remove.isError && <Failure error={remove.error} />}
        <DialogButtons
          label={t("demo.remove")}
          isGrave
          isReady
          isSending={remove.isPending}
          onCancel={onClose}
        />
      </form>
    </Modal>
  );
}
