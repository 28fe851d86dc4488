import { accountHeader, answer, isApiError, server, setAccountOfPage } from "@shared/api/request";
import { afterAll, beforeEach, describe, expect, it, vi } from "vitest";

const otherTab = new BroadcastChannel("reembody-account");

/** A page of its own, which shows this account. */
async function pageOf(account: string | null) {
  vi.resetModules();
  const request = await import("@shared/api/request");
  request.setAccountOfPage(account);
  return { request, tabs: await import("./otherTabs") };
}

const messagesPass = () => new Promise((resolve) => setTimeout(resolve, 50));

describe("tabs of one browser", () => {
  beforeEach(() => setAccountOfPage(null));
  afterAll(() => otherTab.close());

  it("start afresh when somebody else signs in, or somebody signs out, in another one", async () => {
    for (const told of ["admin", null]) {
      const { tabs } = await pageOf("operator");
      otherTab.postMessage(told);
      await messagesPass();
      expect(tabs.hasAccountChanged()).toBe(true);
    }
  });

  it("go on when the same person signs in again in another one", async () => {
    const { tabs } = await pageOf("operator");
    const heard = vi.fn();
    tabs.onSameAccount(heard);
    otherTab.postMessage("operator");
    await messagesPass();
    expect(heard).toHaveBeenCalledOnce();
    expect(tabs.hasAccountChanged()).toBe(false);
  });

  it("start afresh when the server refuses a request of the account they show", async () => {
    const { request, tabs } = await pageOf("operator");
    request.errorFromBody(409, { error: { code: "stale", message: "changed" } });
    expect(tabs.hasAccountChanged()).toBe(false);
    request.errorFromBody(409, { error: { code: "other_account", message: "another" } });
    expect(tabs.hasAccountChanged()).toBe(true);
  });

  it("name the account they show in every request", async () => {
    const named: (string | null)[] = [];
    const refuse = async (request: Request) => {
      named.push(request.headers.get("x-reembody-account"));
      return Response.json({ error: { code: "other_account", message: "no" } }, { status: 409 });
    };
    const ask = () =>
      answer(server.GET("/api/studies", { baseUrl: "http://127.0.0.1", fetch: refuse })).catch(
        (error: unknown) => isApiError(error, "other_account"),
      );
    expect(await ask()).toBe(true);
    setAccountOfPage("operator");
    await ask();
    expect(named).toEqual([null, "operator"]);
    expect(accountHeader()).toEqual({ "x-reembody-account": "operator" });
  });
});
