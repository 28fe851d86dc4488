/**
 * An order that was prepared for a while, with reasons written and put on record meanwhile.
 *
 * Notes and reasons, one's own and those of another operator, change the version of a session and
 * nothing that the order depends on. So it is sent again on the newest version for as long as the
 * session's status is the one that the order was prepared for.
 */
import type { sessions } from "@shared/api/endpoints";
import { isApiError } from "@shared/api/errors";
import type { Command, SessionView } from "@shared/api/types";

export interface Ordered {
  readonly view: SessionView;
  /** Another operator was first: the status is another one, and nothing was sent. */
  readonly overtaken: boolean;
}

/** Operators write one reason after the other, and there are few of both. */
const MOST_TIMES = 20;

/** Raises what the server refuses for another reason, or `stale` when notes never end. */
export async function orderAnew(
  api: Pick<typeof sessions, "get" | "command">,
  seen: SessionView,
  order: Command,
): Promise<Ordered> {
  for (let time = 1; ; time += 1) {
    const fresh = await api.get(seen.id);
    if (fresh.status !== seen.status) return { view: fresh, overtaken: true };
    try {
      return { view: await api.command(seen.id, fresh.version, order), overtaken: false };
    } catch (error) {
      if (!isApiError(error, "stale") || time === MOST_TIMES) throw error;
    }
  }
}
