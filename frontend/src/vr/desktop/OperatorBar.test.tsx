import { MantineProvider } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { renderToStaticMarkup } from "react-dom/server";
import { I18nextProvider } from "react-i18next";
import { describe, expect, it } from "vitest";
import { translations } from "../i18n";
import OperatorBar, { nextOf } from "./OperatorBar";

const AT_FREE_MOVEMENT = {
  id: "s",
  version: 7,
  allowed: ["begin_phase", "skip"],
  current: { index: 0, status: "ready" },
  steps: [{ index: 0, kind: "free_roam", limb: null }],
  devices: [{ kind: "headset", connected: true }],
} as unknown as SessionView;

/** The bar's markup; `session`: what this browser's operator sees, null if nobody is signed in. */
function shown(session: SessionView | null, isWaiting: boolean): string {
  const queries = new QueryClient();
  queries.setQueryData(["operator", "s"], session);
  return renderToStaticMarkup(
    <MantineProvider>
      <I18nextProvider i18n={translations}>
        <QueryClientProvider client={queries}>
          <OperatorBar sessionId="s" isWaiting={isWaiting} />
        </QueryClientProvider>
      </I18nextProvider>
    </MantineProvider>,
  );
}

describe("The experimenter's next step on the participant's page", () => {
  it("is the button that the cockpit shows, for whoever may press it", () => {
    expect(shown(AT_FREE_MOVEMENT, true)).toContain("Begin free movement");
  });

  it("cannot be pressed while the server would refuse it", () => {
    const away = { ...AT_FREE_MOVEMENT, devices: [] };
    expect(shown(AT_FREE_MOVEMENT, true)).not.toContain("disabled");
    expect(shown(away, true)).toContain("disabled");
  });

  it("takes a message about the step before with it, however much else has changed", () => {
    const later = { ...AT_FREE_MOVEMENT, version: 9 };
    expect(nextOf(later)).toBe(nextOf(AT_FREE_MOVEMENT));
    const begun = { ...later, allowed: ["pause"], current: { index: 0, status: "running" } };
    const next = { ...later, current: { index: 1, status: "ready" } };
    for (const view of [begun, next] as unknown as SessionView[]) {
      expect(nextOf(view)).not.toBe(nextOf(AT_FREE_MOVEMENT));
    }
  });

  it("is waited for where nobody is signed in, and only while nothing happens", () => {
    expect(shown(null, true)).toContain("when the experimenter continues");
    expect(shown(null, true)).not.toContain("<button");
    expect(shown(null, false)).not.toContain("experimenter");
  });
});
