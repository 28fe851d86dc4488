/** What saving the draft would change, against the newest version. */
import { drafts } from "@shared/api/drafts";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { DiffView } from "./DiffView";
import type { Draft } from "./useDraft";

interface ChangesProps {
  readonly draft: Draft;
  readonly studyKey: string;
}

export function Changes({ draft, studyKey }: ChangesProps): JSX.Element {
  const { t } = useTexts();
  const usable = draft.upToDate && draft.check?.ok === true;
  const query = useQuery({
    queryKey: ["draft-diff", studyKey, draft.text],
    queryFn: () => drafts.diff(studyKey, draft.text),
    enabled: usable,
    gcTime: 0,
  });
  if (!usable && draft.problems.length > 0) {
    return (
      <Notice tone="warn" title={t("changes.broken")}>
        {t("dryRun.broken.body")}
      </Notice>
    );
  }
  return <Loaded query={query}>{(diff) => <DiffView diff={diff} />}</Loaded>;
}
