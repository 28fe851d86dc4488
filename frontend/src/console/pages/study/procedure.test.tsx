import { MantineProvider } from "@mantine/core";
import type { StudyDetail, StudyProtocol } from "@shared/api/types";
import { renderToStaticMarkup } from "react-dom/server";
import { I18nextProvider } from "react-i18next";
import { beforeAll, describe, expect, it } from "vitest";
import { loaded, translations } from "../../i18n";
import { Procedure } from "./Procedure";

const STUDY = { minutes: 20, planned_minutes: 10 } as unknown as StudyDetail;
const TIMES = { preparation_s: 5, duration_s: 120, freeze_s: 3, questionnaire: "veq" } as const;

/** The markup of a session with two conditions, whose block is given. */
function shown(
  block: Partial<StudyProtocol["procedure"]["block"]>,
  walksBackMin: number | null = null,
): string {
  const protocol = {
    conditions: [{}, {}],
    procedure: { before: [], block: { limb_order: "fixed", phases: [], ...block }, after: [] },
  } as unknown as StudyProtocol;
  return renderToStaticMarkup(
    <MantineProvider>
      <I18nextProvider i18n={translations}>
        <Procedure study={STUDY} protocol={protocol} walksBackMin={walksBackMin} />
      </I18nextProvider>
    </MantineProvider>,
  );
}

beforeAll(() => loaded);

describe("One session as a row of steps", () => {
  it("shows a crossing with its times, its end and its questionnaire", () => {
    const row = shown({ crossing: { ...TIMES, crossings: 2 } });
    expect(row).toContain("Crossing the road");
    for (const words of ["5 s", "120 s", "3 s", "until 2 crossings are done", "Questionnaire"]) {
      expect(row).toContain(words);
    }
  });

  it("adds the walks back of a pilot to the length of a visit, and says where they come from", () => {
    expect(shown({})).toContain("about 20 min");
    const piloted = shown({}, 1.7);
    expect(piloted).toContain("about 22 min");
    expect(piloted).toContain("1.7 min of walks back, as a pilot of this version says (simulated)");
  });

  it("puts the crossing before the tasks of its block", () => {
    const row = shown({
      crossing: { ...TIMES, crossings: 1 },
      phases: [{ ...TIMES, limb: "hand" }],
    });
    const places = ["Crossing the road", "until 1 crossing is done", "Hand task"].map((words) =>
      row.indexOf(words),
    );
    expect(places.every((at) => at >= 0)).toBe(true);
    expect(places).toEqual([...places].sort((one, other) => one - other));
  });
});
