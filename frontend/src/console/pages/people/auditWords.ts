/** An entry of the audit trail as sentences. Unknown actions are shown as they are recorded. */
import type { AuditEntry, Role } from "@shared/api/people";
import type { Door } from "@shared/api/trackers";
import type { Translate } from "@shared/i18n/i18n";
import type { Key } from "../../i18n";

type TranslateEntry = Translate<Key>;

/**
 * The name of an actor: `account:ada` is ada; a device or the command line is called by its kind.
 */
export const actorName = (actor: string): string =>
  actor.startsWith("account:") ? actor.slice("account:".length) : (actor.split(":")[0] ?? actor);

export const subjectName = (subject: string): string => subject.slice(subject.indexOf(":") + 1);

/** What was done; more than one sentence if one action changed several things. */
export function sentences(entry: AuditEntry, t: TranslateEntry): readonly string[] {
  const subject = subjectName(entry.subject);
  const details = entry.details as Readonly<Record<string, unknown>>;
  if (entry.action === "account.changed") return accountChanges(details, subject, t);
  const { role, studies, ended } = details;
  if (entry.action === "invitation.made") {
    const whom = t("act.invitation.made", { role: roleName(role, t) });
    return Array.isArray(studies)
      ? [whom, t("act.invitation.studies", { studies: list(studies) })]
      : [whom];
  }
  if (entry.action === "login.refused" && typeof details["count"] === "number") {
    return [
      t("act.login.refusedMore", {
        refused: details["count"],
        address: String(details["address"]),
      }),
    ];
  }
  const key = SENTENCES[entry.action];
  if (key === undefined) {
    return [`${entry.action} ${subject}`.trim(), rest(details)].filter((part) => part !== "");
  }
  const count = typeof ended === "number" ? ended : 0;
  return [t(key, { ...texts(details, t), count, subject })];
}

/** The sentences of actions that need no more than their own details. */
const SENTENCES: Readonly<Record<string, Key>> = {
  "login.opened": "act.login.opened",
  "login.refused": "act.login.refused",
  "login.revoked": "act.login.revoked",
  "account.made": "act.account.made",
  "account.password": "act.account.password",
  "invitation.revoked": "act.invitation.revoked",
  "demo.loaded": "act.demo.loaded",
  "demo.removed": "act.demo.removed",
  "study.created": "act.study.created",
  "study.version": "act.study.version",
  "study.duplicated": "act.study.duplicated",
  "study.archived": "act.study.archived",
  "study.restored": "act.study.restored",
  "study.exported": "act.study.exported",
  "study.pilot_ordered": "act.study.pilot_ordered",
  "study.pilot_stopped": "act.study.pilot_stopped",
  "study.pilot_resumed": "act.study.pilot_resumed",
  "study.pilot_removed": "act.study.pilot_removed",
  "device.paired": "act.device.paired",
  "device.unpaired": "act.device.unpaired",
  "session.overridden": "act.session.overridden",
  "answer.corrected": "act.answer.corrected",
  "answer.imported": "act.answer.imported",
  "answer.instrument_made": "act.answer.instrument_made",
  "answer.import_undone": "act.answer.import_undone",
  "answer.imported_erased": "act.answer.imported_erased",
  "copy.destroyed": "act.copy.destroyed",
  "capture.added": "act.capture.added",
  "capture.changed": "act.capture.changed",
  "capture.removed": "act.capture.removed",
  "capture.mapped": "act.capture.mapped",
  "capture.unmapped": "act.capture.unmapped",
  "performer.agreed": "act.performer.agreed",
  "tracker.opened": "act.tracker.opened",
  "tracker.closed": "act.tracker.closed",
  "avatar.created": "act.avatar.created",
  "avatar.version": "act.avatar.version",
  "avatar.tuning_ordered": "act.avatar.tuning_ordered",
  "avatar.tuning_stopped": "act.avatar.tuning_stopped",
  "avatar.tuning_resumed": "act.avatar.tuning_resumed",
  "avatar.tuning_removed": "act.avatar.tuning_removed",
  "humanoid.added": "act.humanoid.added",
  "humanoid.measured": "act.humanoid.measured",
  "humanoid.named": "act.humanoid.named",
  "humanoid.titled": "act.humanoid.titled",
  "humanoid.confirmed": "act.humanoid.confirmed",
  "humanoid.removed": "act.humanoid.removed",
  "walking.scene_added": "act.walking.scene_added",
  "walking.scene_removed": "act.walking.scene_removed",
  "walking.walks_added": "act.walking.walks_added",
  "walking.walks_removed": "act.walking.walks_removed",
  "walking.model_ordered": "act.walking.model_ordered",
  "walking.model_stopped": "act.walking.model_stopped",
  "walking.model_resumed": "act.walking.model_resumed",
  "walking.model_removed": "act.walking.model_removed",
  "participant.copied": "act.participant.copied",
  "participant.erased": "act.participant.erased",
  "participant.erased_again": "act.participant.erased_again",
};

/** The kinds to filter by: each stands for all actions whose name starts with it. */
export const KINDS = [
  "login",
  "account",
  "invitation",
  "study",
  "demo",
  "participant",
  "answer",
  "copy",
  "device",
  "session",
  "capture",
  "tracker",
  "performer",
  "avatar",
  "humanoid",
  "walking",
] as const;

function accountChanges(
  { role, studies, closed }: Readonly<Record<string, unknown>>,
  subject: string,
  t: TranslateEntry,
): readonly string[] {
  const changes: string[] = [];
  if (role != null) changes.push(t("act.account.role", { subject, role: roleName(role, t) }));
  if (studies === null) changes.push(t("act.account.allStudies", { subject }));
  if (Array.isArray(studies)) {
    changes.push(
      studies.length === 0
        ? t("act.account.noStudies", { subject })
        : t("act.account.studies", { subject, studies: list(studies) }),
    );
  }
  if (closed === true) changes.push(t("act.account.closed", { subject }));
  if (closed === false) changes.push(t("act.account.reopened", { subject }));
  return changes.length === 0 ? [t("act.account.changed", { subject })] : changes;
}

const ROLE_KEYS: Readonly<Record<Role, Key>> = {
  admin: "role.admin",
  experimenter: "role.experimenter",
  operator: "role.operator",
  analyst: "role.analyst",
};

function roleName(role: unknown, t: TranslateEntry): string {
  const key = ROLE_KEYS[role as Role];
  return key === undefined ? String(role) : t(key);
}

const DOOR_KEYS: Readonly<Record<Door["door"], Key>> = {
  osc: "trackers.door.osc",
  natnet: "trackers.door.natnet",
  json: "trackers.door.json",
};

function doorName(door: unknown, t: TranslateEntry): string {
  const key = DOOR_KEYS[door as Door["door"]];
  return key === undefined ? String(door) : t(key);
}

const list = (values: readonly unknown[]): string => values.map(String).join(", ");

const texts = (details: Readonly<Record<string, unknown>>, t: TranslateEntry) =>
  Object.fromEntries(
    Object.entries(details).map(([name, value]) => [
      name,
      name === "role" ? roleName(value, t) : name === "door" ? doorName(value, t) : String(value),
    ]),
  );

const rest = (details: Readonly<Record<string, unknown>>): string =>
  Object.entries(details)
    .map(([name, value]) => `${name.replaceAll("_", " ")}: ${JSON.stringify(value)}`)
    .join(" · ");
