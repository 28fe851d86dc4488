/** The props of a capture's tabs, and what they show if no avatar can be moved by it. */
import { Button } from "@mantine/core";
import type { Capture } from "@shared/api/captures";
import { Notice } from "@shared/ui/Notice";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import type { JointMapDraft } from "./useJointMap";

export interface TabProps {
  readonly capture: Capture;
  readonly map: JointMapDraft;
}

/** Why the movement cannot be transferred to an avatar, and where to fix that. */
export function NoAvatar({ capture, map }: TabProps): JSX.Element | null {
  const { t } = useTexts();
  let why: ReactNode = null;
  let remedy: JSX.Element | undefined;
  if (!capture.has_skeleton) {
    why = t("capture.noAvatar.skeleton", { why: capture.summary.no_skeleton ?? "" });
  } else if (map.view?.usable === false) {
    why = `${t("capture.noAvatar.map")} ${map.view.missing.join("; ")}`;
    remedy = (
      <Button component={Link} href={`/captures/${capture.id}/joints`} size="xs" variant="default">
        {t("capture.noAvatar.openMap")}
      </Button>
    );
  }
  if (why === null) return null;
  return (
    <div style={{ marginTop: 12 }}>
      <Notice tone="warn" title={t("capture.noAvatar")} remedy={why} actions={remedy} />
    </div>
  );
}
