/** The offer of a new study's unsaved draft: what it is, when it was changed, and what to do. */
import { Button, Group } from "@mantine/core";
import { drafts } from "@shared/api/drafts";
import { dateTime } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { dropDraft, type KeptText, NEW_STUDY } from "./keptDraft";
import classes from "./NewStudy.module.css";
import { isObject, type Json } from "./paths";

/** Where the kept draft is opened. */
const DRAFT_ADDRESS = "/new/draft";

interface NewDraftProps {
  readonly kept: KeptText;
  /** What opens if it is discarded; null where nothing does. */
  readonly instead: string | null;
  readonly onDiscarded: () => void;
}

export function NewDraft({ kept, instead, onDiscarded }: NewDraftProps): JSX.Element {
  const { t, language } = useTexts();
  const name = useDraftName(kept.text);
  const discard = () => {
    dropDraft(NEW_STUDY);
    onDiscarded();
  };
  return (
    <div className={classes.draft}>
      <Notice
        tone="info"
        title={t(instead === null ? "new.draft" : "new.draft.first")}
        actions={
          <Group gap="xs">
            <Button size="xs" component={Link} href={DRAFT_ADDRESS}>
              {t("new.draft.continue")}
            </Button>
            <Button size="xs" variant="default" onClick={discard}>
              {instead === null
                ? t("new.draft.discard")
                : t("new.draft.discardFor", { name: instead })}
            </Button>
          </Group>
        }
      >
        {name}
        {", "}
        {kept.changedAt === null
          ? t("new.draft.earlier")
          : t("new.draft.changed", { time: dateTime(kept.changedAt, language) })}
      </Notice>
    </div>
  );
}

/** The title and the key of a draft; its key alone while or because it cannot be read. */
function useDraftName(text: string): string {
  const { t, language } = useTexts();
  const checked = useQuery({
    queryKey: ["check", text],
    queryFn: () => drafts.check(text),
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 30_000,
  });
  const key = /^key:[ \t]*["']?([^\s"'#]+)/m.exec(text)?.[1] ?? t("new.draft.noKey");
  const tree = checked.data?.tree as Json | undefined;
  const given = isObject(tree) ? tree.title : undefined;
  if (!isObject(given)) return key;
  const titles = Object.entries(given).filter(
    (entry): entry is [string, string] => typeof entry[1] === "string",
  );
  const title = inLanguage(Object.fromEntries(titles), language);
  return title === "" ? key : `${title} (${key})`;
}
