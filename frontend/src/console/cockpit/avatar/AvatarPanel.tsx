/** Which settings of the running avatar were changed, and the buttons to change them. */
import { Button } from "@mantine/core";
import type { AvatarChanges, SessionView } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import { type JSX, useRef, useState } from "react";
import { changeWords } from "../../avatarChanges/words";
import { useTexts } from "../../i18n";
import { Key } from "../../ui/Key";
import cockpit from "../Cockpit.module.css";
import type { useSession } from "../session/useSession";
import { AvatarDialog } from "./AvatarDialog";
import classes from "./AvatarPanel.module.css";

interface AvatarPanelProps {
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
  readonly opened: boolean;
  readonly onOpen: () => void;
  readonly onClose: () => void;
}

/** Whether there is a physics avatar whose settings can be changed, or were. */
export const isChangeable = (session: SessionView): boolean =>
  session.allowed.includes("change_avatar") || session.avatar_changes != null;

export function AvatarPanel(props: AvatarPanelProps): JSX.Element {
  const { session, live, opened, onOpen, onClose } = props;
  const texts = useTexts();
  const { t } = texts;
  const inForce = session.avatar_changes ?? null;
  const mine = inForce?.operator ?? null;
  const earlier = useEarlier(mine);
  // A change to undo is prepared in the dialog, so that one during a phase is confirmed there, too.
  const [prepared, setPrepared] = useState<AvatarChanges | null>(null);
  const may = session.allowed.includes("change_avatar");
  const propose = (changes: AvatarChanges) => {
    if (session.current?.status !== "ready") {
      setPrepared(changes);
      onOpen();
      return;
    }
    live.send({ type: "change_avatar", avatar_changes: changes });
  };
  const close = () => {
    setPrepared(null);
    onClose();
  };
  return (
    <section aria-label={t("avatarChanges.title")} data-tour="avatar">
      <h2 className={cockpit.sectionTitle}>
        {t("avatarChanges.title")}
        {may && <Key name="B" />}
      </h2>
      <Changes title={t("avatarChanges.study")} words={changeWords(texts, inForce?.study)} />
      <Changes title={t("avatarChanges.operator")} words={changeWords(texts, mine)} />
      {inForce?.study == null && mine === null && (
        <p className={classes.none}>{t("avatarChanges.none")}</p>
      )}
      {inForce !== null && <Confirmation session={session} />}
      {may && (
        <div className={classes.buttons}>
          <Button size="xs" variant="light" aria-keyshortcuts="B" onClick={onOpen}>
            {t("avatarChanges.change")}
          </Button>
          {earlier !== undefined && (
            <Button
              size="xs"
              variant="default"
              loading={live.sending}
              onClick={() => propose(earlier ?? {})}
            >
              {t("avatarChanges.undo")}
            </Button>
          )}
          {mine !== null && (
            <Button size="xs" variant="default" loading={live.sending} onClick={() => propose({})}>
              {t("avatarChanges.back")}
            </Button>
          )}
        </div>
      )}
      <AvatarDialog
        session={session}
        live={live}
        opened={opened}
        prepared={prepared ?? mine ?? {}}
        onClose={close}
      />
    </section>
  );
}

function Changes({ title, words }: { readonly title: string; readonly words: readonly string[] }) {
  if (words.length === 0) return null;
  return (
    <div className={classes.changes}>
      <h3 className={classes.by}>{title}</h3>
      <ul>
        {words.map((one) => (
          <li key={one}>{one}</li>
        ))}
      </ul>
    </div>
  );
}

/** Whether the headset carries out what is in force. */
function Confirmation({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const { applied = null, problem = null } = session.avatar_changes ?? {};
  const [icon, tone, text]: [IconName, string | undefined, string] =
    applied === null
      ? ["clock", undefined, t("avatarChanges.waiting")]
      : applied
        ? ["check", undefined, t("avatarChanges.applied")]
        : ["alert", classes.failed, t("avatarChanges.refused")];
  return (
    <p className={`${classes.confirmation} ${tone ?? ""}`} role="status">
      <Icon name={icon} size={15} />
      <span>
        {text}
        {problem !== null && `: ${problem}`}
        {applied === false && session.blinded && `. ${t("avatarChanges.reasonHidden")}`}
      </span>
    </p>
  );
}

/**
 * The operator's changes before the present ones, as seen on this page; undefined if there are
 * none.
 */
function useEarlier(mine: AvatarChanges | null): AvatarChanges | null | undefined {
  const seen = useRef<(AvatarChanges | null)[]>([mine]);
  const last = seen.current.at(-1) ?? null;
  if (JSON.stringify(last) !== JSON.stringify(mine)) {
    const before = seen.current.at(-2);
    const isUndone = before !== undefined && JSON.stringify(before) === JSON.stringify(mine);
    if (isUndone) seen.current.pop();
    else seen.current.push(mine);
  }
  return seen.current.at(-2);
}
