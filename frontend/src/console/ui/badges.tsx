/**
 * Badges for the kind of data, the state of a session, and a role: shape and word, not colour
 * alone.
 */
import type { Role } from "@shared/api/people";
import type { Kind, SessionStatus } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

const KIND_ICONS: Readonly<Record<Kind, IconName>> = {
  people: "people",
  simulated: "body",
  test: "flag",
  expert: "talk",
};

/**
 * The kind of a session: participants, simulated, test or expert. Shape and word, not colour alone.
 */
export function KindBadge({ kind }: { readonly kind: Kind }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={`${classes.badge} ${classes[kind]}`}>
      <Icon name={KIND_ICONS[kind]} size={14} />
      {t(kind === "people" ? "kind.people.one" : `kind.${kind}`)}
    </span>
  );
}

const STATUS_ICONS: Readonly<Record<SessionStatus, IconName>> = {
  planned: "clock",
  active: "play",
  completed: "check",
  aborted: "stop",
  withdrawn: "close",
};

/** All states, in the order in which a session takes them. */
export const STATUSES = Object.keys(STATUS_ICONS) as readonly SessionStatus[];

/** The state of a session as a word and an icon. */
export function StatusBadge({ status }: { readonly status: SessionStatus }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={`${classes.badge} ${classes[status]}`}>
      <Icon name={STATUS_ICONS[status]} size={14} />
      {t(`status.${status}`)}
    </span>
  );
}

/** All roles, in the order in which they are shown. */
export const ROLES: readonly Role[] = ["admin", "experimenter", "operator", "analyst"];

export const ROLE_ICONS: Readonly<Record<Role, IconName>> = {
  admin: "key",
  experimenter: "form",
  operator: "play",
  analyst: "chart",
};

export function RoleBadge({ role }: { readonly role: Role }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.badge}>
      <Icon name={ROLE_ICONS[role]} size={14} />
      {t(`role.${role}`)}
    </span>
  );
}
