/** Height as stated by the participant and as matched to the avatar: both are stored. */
import { Button, NumberInput } from "@mantine/core";
import type { SessionView, StoredAnswers } from "@shared/api/types";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { metresFromCentimetres } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, type ReactNode, useState } from "react";
import { useTexts } from "../../i18n";
import { answersQuery } from "../../queries";
import { Key } from "../../ui/Key";
import type { Send } from "../session/useSession";
import classes from "./CurrentStep.module.css";

const SHORTEST_CM = 100;
const TALLEST_CM = 230;
/**
 * Shoes and posture account for a few centimetres; a larger difference is a mistake, or another
 * person's avatar.
 */
const MAX_DIFFERENCE_CM = 10;

interface HeightFormProps {
  readonly session: SessionView;
  readonly step: number;
  readonly send: Send;
  readonly sending: boolean;
  readonly exceptions: ReactNode;
}

export function HeightForm(props: HeightFormProps): JSX.Element {
  const { session, step, send, sending, exceptions } = props;
  const { t, language } = useTexts();
  const answers = useQuery(answersQuery(session.id, session.version));
  // Prefilled with what the participant entered on the tablet; typing replaces it.
  const [typed, setStated] = useState<number | string | null>(null);
  const stated = typed ?? heightIn(answers.data ?? []) ?? "";
  const [matched, setMatched] = useState<number | string>("");
  // The two heights that were questioned: after a change they are questioned again.
  const [confirmedPair, setConfirmedPair] = useState("");
  const valid = isHeight(stated) && isHeight(matched);
  const difference = valid ? Math.abs(Number(stated) - Number(matched)) : 0;
  const pair = `${stated} ${matched}`;
  const doubtful = difference > MAX_DIFFERENCE_CM;
  const mustConfirm = doubtful && confirmedPair === pair;
  const save = () => {
    if (!isHeight(stated) || !isHeight(matched)) return;
    if (doubtful && !mustConfirm) {
      setConfirmedPair(pair);
      return;
    }
    const height_m = {
      stated: metresFromCentimetres(stated),
      matched: metresFromCentimetres(matched),
    };
    send({ type: "complete_step", step_index: step, height_m });
  };
  const problem = (height: number | string) =>
    height === "" || isHeight(height)
      ? null
      : t("height.impossible", { shortest: SHORTEST_CM, tallest: TALLEST_CM });
  const common = {
    min: SHORTEST_CM,
    max: TALLEST_CM,
    // What was typed stays and is rejected with a message: a corrected height would be nobody's.
    clampBehavior: "none" as const,
    suffix: " cm",
    decimalScale: 1,
    size: "md",
    placeholder: "cm",
  };
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        save();
      }}
    >
      <div className={classes.height}>
        <NumberInput
          {...common}
          label={t("height.stated")}
          value={stated}
          error={problem(stated)}
          onChange={setStated}
        />
        <NumberInput
          {...common}
          label={t("height.matched")}
          value={matched}
          error={problem(matched)}
          onChange={setMatched}
        />
      </div>
      {mustConfirm && (
        <div className={classes.doubt}>
          <Notice tone="warn" title={t("height.differs")}>
            {t("height.differs.body", { difference: number(difference, language, 1) })}
          </Notice>
        </div>
      )}
      <div className={classes.actions}>
        <Button
          type="submit"
          size="lg"
          className={classes.primary ?? ""}
          disabled={!valid}
          loading={sending}
          leftSection={<Icon name="check" />}
          rightSection={<Key name={t("keys.enter")} />}
        >
          {t(mustConfirm ? "height.differs.save" : "do.complete.height")}
        </Button>
        {exceptions}
      </div>
    </form>
  );
}

/** The height from a form of this session, in centimetres. */
function heightIn(forms: readonly StoredAnswers[]): number | null {
  const heights = forms.map((form) => form.answers.height_cm).filter(isHeight);
  return heights.at(-1) ?? null;
}

const isHeight = (value: unknown): value is number =>
  typeof value === "number" && value >= SHORTEST_CM && value <= TALLEST_CM;
