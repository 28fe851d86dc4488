/** The cockpit's header: participant, study, order, and whether this page is up to date. */

import { ActionIcon, Button, Tooltip } from "@mantine/core";
import type { FeedState } from "@shared/api/live";
import type { SessionView } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useEffect, useState } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { isOver } from "../steps";
import { KindBadge, StatusBadge } from "../ui/badges";
import { Order } from "../ui/Order";
import classes from "./Cockpit.module.css";
import { ConnectionMark } from "./ConnectionMark";
import { RevealCondition } from "./RevealCondition";

interface HeaderProps {
  readonly session: SessionView;
  readonly feed: FeedState;
  /** Missing while the list is on the page anyway, or when there is nothing left to check. */
  readonly onChecks: (() => void) | undefined;
  /** Missing before the start, when nothing can have been recorded. */
  readonly onReceipt: (() => void) | undefined;
  readonly onLog: () => void;
  readonly onHelp: () => void;
}

export function Header(props: HeaderProps): JSX.Element {
  const { session, feed, onChecks, onReceipt, onLog, onHelp } = props;
  const { t, language } = useTexts();
  const can = usePermissions();
  return (
    <div className={classes.head}>
      <div className={classes.who}>
        <h1 className={classes.participant}>{session.participant_code}</h1>
        <div className={classes.study}>
          <Link href={`/studies/${session.study_key}/sessions`}>
            {inLanguage(session.study_title, language)}
          </Link>
          {" · "}
          {t("study.version", { version: session.study_version })}
          {session.slot !== null && ` · ${t("head.slot", { number: session.slot.index + 1 })}`}
          <SessionAvatar session={session} />
        </div>
      </div>
      <KindBadge kind={session.kind} />
      <StatusBadge status={session.status} />
      {session.sequence === null ? (
        <span className={classes.hiddenOrder}>
          <Icon name="lock" size={15} />
          {t("order.hidden")}
          <RevealCondition session={session} />
        </span>
      ) : (
        <Order sequence={session.sequence} bodies={session.bodies} />
      )}
      <div className={classes.tools} data-tour="head">
        <Feed state={feed} ended={session.ended_at !== null} />
        {can("run") && hasConsent(session) && (
          <Button
            component={Link}
            href={`/sessions/${session.id}/consent`}
            variant="default"
            size="xs"
            leftSection={<Icon name="document" size={16} />}
          >
            {t("consent.link")}
          </Button>
        )}
        {can("run") && session.status === "planned" && (
          <Tooltip label={t("outage.open")}>
            <ActionIcon
              component={Link}
              href={`/sessions/${session.id}/outage`}
              variant="default"
              size="md"
              aria-label={t("outage.open")}
            >
              <Icon name="plug" size={18} />
            </ActionIcon>
          </Tooltip>
        )}
        {onChecks !== undefined && (
          <Tooltip label={t("preflight.open")}>
            <ActionIcon
              variant="default"
              size="md"
              aria-label={t("preflight.open")}
              onClick={onChecks}
            >
              <Icon name="flag" size={18} />
            </ActionIcon>
          </Tooltip>
        )}
        {session.ended_at === null && session.phases.some(isOver) && (
          <Button
            component="a"
            href={`#/sessions/${encodeURIComponent(session.id)}/replay`}
            data-tour="replay"
            variant="default"
            size="xs"
            leftSection={<Icon name="play" size={16} />}
          >
            {t("replay.open")}
          </Button>
        )}
        {onReceipt !== undefined && (
          <Tooltip label={t("receipt.title")}>
            <ActionIcon
              variant="default"
              size="md"
              aria-label={t("receipt.title")}
              onClick={onReceipt}
            >
              <Icon name="check" size={18} />
            </ActionIcon>
          </Tooltip>
        )}
        <Button
          variant="default"
          size="xs"
          leftSection={<Icon name="list" size={16} />}
          onClick={onLog}
        >
          {t("head.log")}
        </Button>
        <Tooltip label={t("keys.title")}>
          <ActionIcon variant="default" size="md" aria-label={t("keys.title")} onClick={onHelp}>
            <Icon name="help" size={18} />
          </ActionIcon>
        </Tooltip>
      </div>
    </div>
  );
}

/** The version of the avatar and its content hash, with the way to it. */
function SessionAvatar({ session }: { readonly session: SessionView }): JSX.Element | null {
  const { t } = useTexts();
  const { avatar_version: avatar = null, avatar_configuration_hash: hash = null } = session;
  if (avatar === null || hash === null) return null;
  const { key, title, version } = avatar;
  return (
    <>
      {" · "}
      <Link href={`/avatars/${key}/${version}`} title={t("head.avatar.hash", { hash })}>
        {t("head.avatar", { title, version })}
      </Link>{" "}
      <code title={hash}>{hash.slice(0, 8)}</code>
    </>
  );
}

const hasConsent = ({ steps }: SessionView): boolean =>
  steps.some((step) => step.kind === "consent" && step.status === "done");

/** A short loss of connection does not deserve a warning; a longer one does. */
const WARN_AFTER_MS = 1500;

interface FeedProps {
  readonly state: FeedState;
  /** A session that has ended is no longer shown as live; a lost connection still is. */
  readonly ended: boolean;
}

function Feed({ state, ended }: FeedProps): JSX.Element | null {
  const { t } = useTexts();
  const [shown, setShown] = useState(state);
  useEffect(() => {
    const timer = setTimeout(() => setShown(state), state === "lost" ? WARN_AFTER_MS : 0);
    return () => clearTimeout(timer);
  }, [state]);
  if (ended && shown !== "lost") return null;
  return (
    <span className={`${classes.feed} ${shown === "lost" ? classes.feedLost : ""}`} role="status">
      <ConnectionMark connected={shown === "live"} />
      {t(`feed.${shown}`)}
    </span>
  );
}
