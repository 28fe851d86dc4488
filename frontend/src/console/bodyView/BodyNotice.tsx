/** Says that a body is being loaded, or why it cannot be shown. */
import { Button, Loader } from "@mantine/core";
import { isUnloaded } from "@shared/ui/unloaded";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./BodyViewer.module.css";
import type { BodyState } from "./useBody";

interface BodyNoticeProps {
  readonly body: BodyState;
  /** Whether something else is drawn instead. */
  readonly instead?: boolean;
}

/** Says that pictures of the model are missing, so that its parts are grey, and what to do. */
function Plain({ body }: { readonly body: BodyState }): JSX.Element {
  const { t } = useTexts();
  const { count = 0, isDecoderMissing = false } = body.model?.missing ?? {};
  return (
    <span className={classes.corner} role="status">
      {t(isDecoderMissing ? "bodyView.plain.decoder" : "bodyView.plain", { count })}
      {isDecoderMissing && (
        <Button size="compact-xs" variant="default" onClick={body.retry}>
          {t("error.retry")}
        </Button>
      )}
    </span>
  );
}

export function BodyNotice({ body, instead = false }: BodyNoticeProps): JSX.Element | null {
  const { t } = useTexts();
  if (body.state === "loading") {
    return (
      <span className={instead ? classes.corner : classes.middle} role="status">
        <Loader size="xs" /> {t("bodyView.loading")}
      </span>
    );
  }
  if (body.model !== null && body.model.missing.count > 0) return <Plain body={body} />;
  if (body.state !== "failed") return null;
  return (
    <span className={instead ? classes.corner : classes.middle} role="status">
      {t(instead ? "bodyView.failed.skeleton" : "bodyView.failed", {
        reason: isUnloaded(body.error) ? t("page.unknown") : (body.error?.message ?? ""),
      })}
      <Button size="compact-xs" variant="default" onClick={body.retry}>
        {t("error.retry")}
      </Button>
    </span>
  );
}
