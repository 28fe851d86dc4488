import { ApiError } from "@shared/api/request";
import type { Command, SessionView } from "@shared/api/types";
import { describe, expect, it } from "vitest";
import { resendOnLatestVersion } from "./useSession";

const START: Command = { type: "start" };
const view = (changed: Partial<SessionView> = {}): SessionView =>
  ({ id: "one", status: "planned", version: 4, ...changed }) as SessionView;

/** A server whose session goes through these views, one at each request. */
function server(views: readonly SessionView[], refusal?: ApiError) {
  const sent: number[] = [];
  let at = 0;
  return {
    sent,
    get: async (): Promise<SessionView> => views[Math.min(at, views.length - 1)] as SessionView,
    command: async (_: string, version: number): Promise<SessionView> => {
      sent.push(version);
      if (refusal !== undefined) throw refusal;
      at += 1;
      const now = views[Math.min(at, views.length - 1)] as SessionView;
      if (now.version !== version) throw new ApiError(409, { code: "stale", message: "stale" });
      return view({ status: "active", version: version + 1 });
    },
  };
}

describe("a command that was prepared for a while", () => {
  it("succeeds although another operator's notes arrive in between", async () => {
    const api = server([view(), view({ version: 5 }), view({ version: 6 }), view({ version: 6 })]);
    const done = await resendOnLatestVersion(api, view(), START);
    expect(done).toEqual({ view: view({ status: "active", version: 7 }), overtaken: false });
    expect(api.sent).toEqual([4, 5, 6]);
  });

  it("is not resent once another operator was first", async () => {
    const started = view({ status: "active", version: 5 });
    const api = server([view(), started]);
    expect(await resendOnLatestVersion(api, view(), START)).toEqual({
      view: started,
      overtaken: true,
    });
    expect(api.sent).toEqual([4]);
  });

  it("reports every other refusal immediately, and gives up in the end", async () => {
    const refusal = new ApiError(409, { code: "not_now", message: "no" });
    const refused = server([view()], refusal);
    await expect(resendOnLatestVersion(refused, view(), START)).rejects.toBe(refusal);
    expect(refused.sent).toEqual([4]);
    const stale = new ApiError(409, { code: "stale", message: "stale" });
    const endless = server([view()], stale);
    await expect(resendOnLatestVersion(endless, view(), START)).rejects.toBe(stale);
    expect(endless.sent).toHaveLength(20);
  });
});
