/** Requests for participants' rights: a copy, a correction or an erasure of their data. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { Instrument, Kind, SessionStatus, StoredAnswers } from "./types";

type Schemas = components["schemas"];
export type ErasureReason = Schemas["ErasureRequest"]["reason_code"];
export type RemainingCopy = Schemas["CopyLeft"];
export type Copy = Schemas["CopyView"];
export type Erasure = Schemas["ErasureView"];
export type Correction = Schemas["CorrectionView"];
export type AnswerValue = string | number | boolean | null;
export type Form = Omit<StoredAnswers, "definition"> & { readonly definition: Instrument };
export type Visit = Omit<Schemas["ParticipantSession"], "status"> & {
  readonly status: SessionStatus;
};
export type Participant = Omit<Schemas["ParticipantView"], "kind" | "sessions"> & {
  readonly kind: Kind;
  readonly sessions: readonly Visit[];
};

interface NewCorrection {
  readonly item: string;
  readonly value: AnswerValue;
  readonly reason: string;
}

export const rights = {
  participants: (key: string) =>
    answer<readonly Participant[]>(
      server.GET("/api/studies/{key}/participants", { params: { path: { key } } }),
    ),
  erase: (key: string, participantId: string, confirm: string, reason: ErasureReason) =>
    answer<Erasure>(
      server.POST("/api/studies/{key}/participants/{participant_id}/erasure", {
        params: { path: { key, participant_id: participantId } },
        body: { confirm, reason_code: reason },
      }),
    ),
  accessUrl: (key: string, participantId: string) =>
    `/api/studies/${encodeURIComponent(key)}/participants/${encodeURIComponent(participantId)}/access`,
  copies: (key: string) =>
    answer<readonly Copy[]>(server.GET("/api/studies/{key}/copies", { params: { path: { key } } })),
  destroyed: (copyId: string) =>
    answer<Copy>(
      server.POST("/api/copies/{copy_id}/destroyed", { params: { path: { copy_id: copyId } } }),
    ),
  answers: (sessionId: string) =>
    answer<readonly Form[]>(
      server.GET("/api/sessions/{session_id}/answers", {
        params: { path: { session_id: sessionId } },
      }),
    ),
  correct: (sessionId: string, submissionId: string, correction: NewCorrection) =>
    answer<Form>(
      server.POST("/api/sessions/{session_id}/submissions/{submission_id}/corrections", {
        params: { path: { session_id: sessionId, submission_id: submissionId } },
        body: correction,
      }),
    ),
};
