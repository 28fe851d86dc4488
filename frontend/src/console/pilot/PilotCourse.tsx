/** One pilot: what it is, how far it is, and what may be done with it. */
import { Button, Progress, Title } from "@mantine/core";
import { isApiError } from "@shared/api/request";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { DeleteDialog } from "../ui/DeleteDialog";
import classes from "./Pilot.module.css";
import { type Pilot, pilots } from "./pilots";
import { courseOf, whatOf } from "./words";

interface PilotCourseProps {
  readonly studyKey: string;
  readonly pilot: Pilot;
  readonly onChanged: (pilot: Pilot) => unknown;
  readonly onDeleted: () => unknown;
}

export function PilotCourse(props: PilotCourseProps): JSX.Element {
  const { studyKey, pilot, onChanged, onDeleted } = props;
  const { t } = useTexts();
  const can = usePermissions();
  const [isAsking, setAsking] = useState(false);
  const { id, state } = pilot;
  const act = useMutation({
    mutationFn: (what: "stop" | "resume") => pilots[what](studyKey, id),
    onSuccess: onChanged,
  });
  // Stop was pressed when it had just ended: the state says all there is to say.
  const failure = isApiError(act.error, "not_now") && state === "ready" ? null : act.error;
  const mayResume = state === "stopped" || state === "failed";
  return (
    <>
      <div className={classes.head}>
        <Title order={2} size="h3">
          <span className={classes.mark}>{t("simulated.watermark")}</span> {whatOf(t, pilot)}
        </Title>
        <div className={classes.buttons}>
          {can("design") && state === "simulating" && (
            <Button
              variant="default"
              leftSection={<Icon name="stop" size={16} />}
              loading={act.isPending}
              onClick={() => act.mutate("stop")}
            >
              {t("pilot.stop")}
            </Button>
          )}
          {can("design") && mayResume && (
            <Button
              leftSection={<Icon name="play" size={16} />}
              loading={act.isPending}
              onClick={() => act.mutate("resume")}
            >
              {t("pilot.resume")}
            </Button>
          )}
          {state === "ready" && (
            <Button
              component="a"
              variant="default"
              href={pilots.recordUrl(studyKey, id)}
              leftSection={<Icon name="download" size={16} />}
            >
              {t("pilot.record")}
            </Button>
          )}
          {can("design") && (
            <Button variant="default" onClick={() => setAsking(true)}>
              {t("pilot.delete")}
            </Button>
          )}
        </div>
      </div>
      {failure !== null && <Failure error={failure} />}
      <Course pilot={pilot} />
      <DeleteDialog
        isOpen={isAsking}
        title={t("pilot.delete.title")}
        words={t("pilot.delete.words", { what: whatOf(t, pilot) })}
        onDelete={() => pilots.remove(studyKey, id)}
        onClose={() => setAsking(false)}
        onDeleted={onDeleted}
      />
    </>
  );
}

function Course({ pilot }: { readonly pilot: Pilot }): JSX.Element | null {
  const { t } = useTexts();
  const { state, progress, trouble } = pilot;
  if (state === "ready" || progress === null) return null;
  if (state === "failed") {
    return <Notice tone="bad">{t("pilot.failed.why", { why: trouble ?? "" })}</Notice>;
  }
  const words = courseOf(t, pilot);
  const percent = progress.total === 0 ? 0 : (100 * progress.done) / progress.total;
  return (
    <div className={classes.course}>
      <p role="status">
        {state !== "stopped"
          ? words
          : t(progress.total === 0 ? "pilot.stopped.early" : "pilot.stopped.at", { words })}
      </p>
      <Progress value={percent} aria-label={t("pilot.progress")} />
    </div>
  );
}
