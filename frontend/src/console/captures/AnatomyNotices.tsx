/** What anatomy does not allow in a capture or in a walk made of it, and whether it was mended. */
import type { AnatomyNotice } from "@shared/api/captures";
import { Notice, type Tone } from "@shared/ui/Notice";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";

const TONES: Readonly<Record<AnatomyNotice["action"], Tone>> = {
  mended: "warn",
  refused: "bad",
  noted: "info",
};

export function AnatomyNotices({
  notices,
}: {
  readonly notices: readonly AnatomyNotice[];
}): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      {notices.map((notice) => (
        <Notice
          key={`${notice.rule} ${notice.what}`}
          tone={TONES[notice.action]}
          title={`${t(`anatomy.rule.${notice.rule}`)} ${t(`anatomy.action.${doneOf(notice)}`)}`}
          remedy={t(remedyOf(notice))}
        >
          {/* Names of segments and units come from the server, in English as in the file. */}
          <span lang="en">{t("anatomy.found", { value: notice.value, valid: notice.valid })}</span>
        </Notice>
      ))}
    </>
  );
}

/** A unit is neither mended nor left: it was guessed. */
const doneOf = ({ rule, action }: AnatomyNotice): AnatomyNotice["action"] | "guessed" =>
  rule === "unit" ? "guessed" : action;

/** A mirrored file is mirrored back; sides that a joint map exchanges have to be mended there. */
function remedyOf({ rule, action }: AnatomyNotice): Key {
  return rule === "mirrored" && action === "refused"
    ? "anatomy.remedy.exchanged"
    : `anatomy.remedy.${rule}`;
}
