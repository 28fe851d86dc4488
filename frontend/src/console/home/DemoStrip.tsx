/** On every page of the demo lab: that its people are simulated, how many are there, its removal. */
import { Button, Modal, Progress } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { notifications } from "@mantine/notifications";
import { DEMO_KEY } from "@shared/api/housekeeping";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { Failure } from "../errors";
import { useCurrentStudy } from "../frame/currentStudy";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { DialogButtons } from "../ui/DialogButtons";
import { useDemo, useLoadDemo, useRemoveDemo } from "./demo";
import classes from "./Home.module.css";

export function DemoStrip(): JSX.Element | null {
  const { t } = useTexts();
  const [address] = useLocation();
  const can = usePermissions();
  const study = useCurrentStudy(address);
  const demo = useDemo(can("demo"));
  // Absent although there is a study with its key: somebody else's, with people in it.
  const isOfDemo = address.startsWith("/s") && study?.key === DEMO_KEY && demo?.state !== "absent";
  const load = useLoadDemo();
  const [asking, ask] = useDisclosure();
  const isLoading = demo?.state === "loading";
  if (!isOfDemo && !isLoading) return null;
  const counts = { completed: demo?.completed ?? 0, people: demo?.people ?? 0 };
  const isPart = demo?.state === "stopped" || demo?.state === "failed";
  return (
    <section className={classes.strip} aria-label={t("demo.label")}>
      <Icon name="body" size={17} />
      <strong>{t("simulated.watermark")}</strong>
      <span role="status">
        {isLoading
          ? t("demo.loading", counts)
          : demo?.state === "failed"
            ? t("demo.failed", { message: demo.message ?? "" })
            : demo?.state === "stopped"
              ? t("demo.stopped", counts)
              : t("demo.loaded")}
      </span>
      {isLoading && (
        <Progress
          className={classes.loadingBar ?? ""}
          value={(100 * counts.completed) / Math.max(1, counts.people)}
          aria-label={t("demo.loading", counts)}
        />
      )}
      {can("demo") && (
        <span className={classes.stripButtons}>
          {!isOfDemo && (
            <Button
              component={Link}
              href={`/studies/${DEMO_KEY}/dashboard`}
              size="compact-xs"
              variant="default"
            >
              {t("demo.results")}
            </Button>
          )}
          {isPart && (
            <Button
              size="compact-xs"
              variant="default"
              loading={load.isPending}
              onClick={() => load.mutate()}
            >
              {t("demo.more")}
            </Button>
          )}
          <Button size="compact-xs" variant="subtle" color="gray" onClick={ask.open}>
            {t("demo.remove")}
          </Button>
        </span>
      )}
      {load.isError && <Failure error={load.error} />}
      <RemoveDialog opened={asking} onClose={ask.close} />
    </section>
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
