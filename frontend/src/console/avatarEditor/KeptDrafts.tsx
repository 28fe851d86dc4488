/** What earlier visits and other tabs have left unsaved: continue it, download it or discard it. */
import { Button, Group } from "@mantine/core";
import { dateTime } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useLayoutEffect, useRef, useState } from "react";
import { useAccount } from "../account";
import { useTexts } from "../i18n";
import { type AvatarVersionDetail, type AvatarView, versionQuery } from "./api";
import type { AvatarFile } from "./axes";
import { changesIn, type KeptDraft, keepDraft, keptDrafts, slotOf, startOf } from "./keptDrafts";
import { loadFile } from "./operations";
import type { Work } from "./useWork";

export interface Kept {
  /** False while the browser does not store the work of this page. */
  readonly isKept: boolean;
  readonly drafts: readonly KeptDraft[];
  readonly isTaking: boolean;
  readonly take: (draft: KeptDraft) => void;
  readonly discard: (draft: KeptDraft) => void;
  /** Forget the work of this page, because it was saved. */
  readonly forget: () => void;
}

const newSlot = (avatarKey: string) =>
  slotOf(avatarKey, Array.from(crypto.getRandomValues(new Uint32Array(3))).join("-"));

/** Keep the work of this page in the browser, and offer what others have left. */
export function useKeptDrafts(
  avatar: AvatarView,
  base: AvatarVersionDetail,
  onBase: (version: AvatarVersionDetail) => void,
  work: Work,
  isChanged: boolean,
): Kept {
  const { t } = useTexts();
  const queries = useQueryClient();
  const avatarKey = avatar.key;
  const by = useAccount().data?.id ?? "";
  const baseHash = base.content_hash;
  const { configuration } = work;
  const [own, setOwn] = useState(() => newSlot(avatarKey));
  const [drafts, setDrafts] = useState(() => keptDrafts(localStorage, avatarKey, own, by));
  const [isKept, setKept] = useState(true);
  const [isTaking, setTaking] = useState(false);
  useEffect(() => {
    // What is being taken goes to a slot of its own once the server has accepted it.
    if (isTaking) return;
    const keep = () => {
      const draft = { by, baseHash, configuration, at: new Date().toISOString() };
      if (!isChanged) localStorage.removeItem(own);
      setKept(!isChanged || keepDraft(localStorage, own, draft));
    };
    keep();
    // Another tab may take or discard what this one is still working on.
    const onStorage = (event: StorageEvent) => {
      if (isChanged && event.key === own && event.newValue === null) keep();
    };
    window.addEventListener("storage", onStorage);
    return () => window.removeEventListener("storage", onStorage);
  }, [own, by, baseHash, configuration, isChanged, isTaking]);
  const discard = (draft: KeptDraft) => {
    localStorage.removeItem(draft.slot);
    setDrafts(keptDrafts(localStorage, avatarKey, own, by));
  };
  const take = async (draft: KeptDraft) => {
    if (draft.configuration === null) return;
    setTaking(true);
    const start = startOf(draft, avatar.versions) ?? base.number;
    const [load, label] = [loadFile(draft.configuration), t("avatars.did.kept")];
    let from = base;
    let isTaken = false;
    try {
      // It goes on from the version that it began from: what was saved since is shown at saving.
      if (start !== base.number) from = await queries.fetchQuery(versionQuery(avatarKey, start));
      isTaken = await (from === base ? work.edit(load, label) : work.editFrom(from, load, label));
    } catch (failure) {
      work.fail(failure);
    }
    if (isTaken) {
      onBase(from);
      // A new slot: the one of this page keeps what was changed here before. The old slot goes
      // only if its content is stored in the new one.
      const next = newSlot(avatarKey);
      const copy = {
        by,
        baseHash: from.content_hash,
        configuration: draft.configuration,
        at: new Date().toISOString(),
      };
      if (keepDraft(localStorage, next, copy)) localStorage.removeItem(draft.slot);
      setOwn(next);
      const others = keptDrafts(localStorage, avatarKey, next, by);
      setDrafts(others.filter((one) => one.slot !== draft.slot));
    }
    setTaking(false);
  };
  return {
    isKept,
    drafts,
    isTaking,
    take: (draft) => void take(draft),
    discard,
    forget: () => localStorage.removeItem(own),
  };
}

interface KeptDraftsProps {
  readonly kept: Kept;
  readonly avatar: AvatarView;
  readonly base: AvatarVersionDetail;
  readonly configuration: AvatarFile;
  /** The offer goes, and with it the button that has the focus. */
  readonly onGone: () => void;
}

export function KeptDrafts(props: KeptDraftsProps): JSX.Element {
  const { kept, avatar, base, configuration, onGone } = props;
  const { t } = useTexts();
  const offers = useRef<HTMLDivElement>(null);
  const count = kept.drafts.length;
  const before = useRef(count);
  // After the offer has gone: its button was disabled while the server answered, so that the focus
  // may have been lost long before.
  useLayoutEffect(() => {
    const isFewer = count < before.current;
    before.current = count;
    if (!isFewer || document.activeElement !== document.body) return;
    const left = offers.current?.querySelector<HTMLElement>("button");
    if (left == null) onGone();
    else left.focus();
  }, [count, onGone]);
  return (
    <>
      {!kept.isKept && (
        <Notice
          tone="warn"
          title={t("avatars.kept.not")}
          actions={<Download avatarKey={avatar.key} content={asText(configuration)} />}
        >
          {t("avatars.kept.not.remedy")}
        </Notice>
      )}
      {kept.drafts.length > 0 && (
        <Notice tone="info" title={t("avatars.kept")}>
          <div ref={offers}>
            {kept.drafts.map((draft) => (
              <Offer key={draft.slot} draft={draft} kept={kept} avatar={avatar} base={base} />
            ))}
          </div>
        </Notice>
      )}
    </>
  );
}

interface OfferProps extends Pick<KeptDraftsProps, "kept" | "avatar" | "base"> {
  readonly draft: KeptDraft;
}

function Offer({ draft, kept, avatar, base }: OfferProps): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const count = changesIn(draft, base.configuration);
  const words = [
    draft.at === null ? t("avatars.kept.earlier") : dateTime(draft.at, language),
    count === null ? t("avatars.kept.unreadable") : extent(draft, count, avatar, base, t),
  ].join(", ");
  return (
    <Group gap="xs" mt={6} role="group" aria-label={words}>
      <span className="numbers">{words}</span>
      {count !== null && (
        <Button size="xs" loading={kept.isTaking} onClick={() => kept.take(draft)}>
          {t("avatars.kept.take")}
        </Button>
      )}
      <Download
        avatarKey={avatar.key}
        content={draft.configuration === null ? draft.text : asText(draft.configuration)}
      />
      <Button
        size="xs"
        variant="default"
        disabled={kept.isTaking}
        onClick={() => kept.discard(draft)}
      >
        {t("avatars.kept.drop")}
      </Button>
    </Group>
  );
}

/** How much a draft changes, or which version it began from if others were saved since. */
function extent(
  draft: KeptDraft,
  count: number,
  avatar: AvatarView,
  base: AvatarVersionDetail,
  t: ReturnType<typeof useTexts>["t"],
): string {
  const start = startOf(draft, avatar.versions);
  const newest = avatar.newest.number;
  if (start === base.number) return t("avatars.changes", { count });
  return start === null
    ? t("avatars.kept.unknownStart", { count })
    : t("avatars.kept.began", { start, newest });
}

interface DownloadProps {
  readonly avatarKey: string;
  readonly content: string;
}

function Download({ avatarKey, content }: DownloadProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Button
      size="xs"
      variant="default"
      component="a"
      href={`data:application/json;charset=utf-8,${encodeURIComponent(content)}`}
      download={`${avatarKey}-unsaved.json`}
    >
      {t("avatars.kept.download")}
    </Button>
  );
}

/** A draft as a file that can be loaded again. */
const asText = (configuration: AvatarFile): string => JSON.stringify(configuration, null, 2);
