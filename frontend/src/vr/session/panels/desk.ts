/** The requests of the panels: the form that is due, its answers, and that a text was read. */
import { answer, server } from "@shared/api/request";
import type { Administration, Receipt, Submission } from "@shared/api/types";

/** The database of this browser in which the forms of headsets are kept. */
export const HEADSET_FORMS = "reembody-headset-forms";

/** What the panels ask of the server; each throws ApiError or Unreachable. */
export interface Desk {
  /** The form that is due inside the headset. */
  form(): Promise<Administration>;
  submit(submission: Submission): Promise<Receipt>;
  /** The text of this step was read: complete the step. */
  acknowledge(stepIndex: number): Promise<void>;
}

/** The server's desk for the headset with this token. */
export function deskOf(token: string): Desk {
  const headers = { authorization: `Bearer ${token}` };
  return {
    form: () => answer<Administration>(server.GET("/api/vr/form", { headers })),
    submit: (submission) =>
      answer<Receipt>(server.POST("/api/vr/submissions", { headers, body: submission })),
    acknowledge: (stepIndex) =>
      answer<void>(
        server.POST("/api/vr/acknowledge", { headers, body: { step_index: stepIndex } }),
      ),
  };
}
