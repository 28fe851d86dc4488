/** Requests for accounts, invitations and the audit trail. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { Account, SessionView } from "./types";

type Schemas = components["schemas"];
export type Person = Schemas["PersonView"];
export type Role = Account["role"];
export type Invitation = Schemas["InvitationView"];
export type Invited = Schemas["InvitedView"];
export type InvitationLook = Schemas["InvitationLook"];
export type AuditEntry = Schemas["AuditView"];
export type AuditPage = Schemas["AuditPage"];
export type AuditCheck = Schemas["AuditCheckView"];

/** Keys of studies; null means all studies, including future ones. */
export type StudyKeys = readonly string[] | null;

export interface PersonChange {
  readonly role?: Role;
  readonly studies?: StudyKeys;
  readonly closed?: boolean;
}

export interface NewInvitation {
  readonly role: Role;
  readonly note: string;
  readonly studies: StudyKeys;
  readonly hours: number;
}

const one = (id: string) => ({ params: { path: { account_id: id } } });

export const people = {
  list: () => answer<readonly Person[]>(server.GET("/api/accounts")),
  change: (id: string, change: PersonChange) =>
    answer<Person>(server.PATCH("/api/accounts/{account_id}", { ...one(id), body: change })),
  endLogins: (id: string) =>
    answer<void>(server.DELETE("/api/accounts/{account_id}/logins", one(id))),
  changePassword: (current: string, fresh: string) =>
    answer<void>(server.PUT("/api/me/password", { body: { current, new: fresh } })),
};

export const invitations = {
  list: () => answer<readonly Invitation[]>(server.GET("/api/invitations")),
  make: (wish: NewInvitation) => answer<Invited>(server.POST("/api/invitations", { body: wish })),
  revoke: (id: string) =>
    answer<void>(
      server.DELETE("/api/invitations/{invitation_id}", {
        params: { path: { invitation_id: id } },
      }),
    ),
  preview: (token: string) =>
    answer<InvitationLook>(server.POST("/api/invitations/look", { body: { token } })),
  accept: (token: string, username: string, password: string) =>
    answer<{ account: Account }>(
      server.POST("/api/invitations/accept", { body: { token, username, password } }),
    ),
};

export interface AuditFilter {
  readonly actor: string | null;
  readonly action: string | null;
}

export const audit = {
  page: ({ actor, action }: AuditFilter, before: number | null) =>
    answer<AuditPage>(server.GET("/api/audit", { params: { query: { actor, action, before } } })),
  check: () => answer<AuditCheck>(server.GET("/api/audit/check")),
};

export const blinding = {
  reveal: (sessionId: string, reason: string) =>
    answer<SessionView>(
      server.POST("/api/sessions/{session_id}/reveal", {
        params: { path: { session_id: sessionId } },
        body: { reason },
      }),
    ),
};
