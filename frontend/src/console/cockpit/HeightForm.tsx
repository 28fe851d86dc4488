/** Height as the participant states it and as it was matched to the avatar: both are kept. */
import { Button, NumberInput } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { metresFromCentimetres } from "@shared/units";
import { type JSX, type ReactNode, useState } from "react";
import { useTexts } from "../i18n";
import { Key } from "../ui/Key";
import classes from "./CurrentStep.module.css";
import type { Send } from "./useSession";

const SHORTEST_CM = 100;
const TALLEST_CM = 230;

interface HeightFormProps {
  readonly step: number;
  readonly send: Send;
  readonly sending: boolean;
  readonly exceptions: ReactNode;
}

export function HeightForm({ step, send, sending, exceptions }: HeightFormProps): JSX.Element {
  const { t } = useTexts();
  const [stated, setStated] = useState<number | string>("");
  const [matched, setMatched] = useState<number | string>("");
  const valid = isHeight(stated) && isHeight(matched);
  const save = () => {
    if (!isHeight(stated) || !isHeight(matched)) return;
    const height_m = {
      stated: metresFromCentimetres(stated),
      matched: metresFromCentimetres(matched),
    };
    send({ type: "complete_step", step_index: step, height_m });
  };
  const common = {
    min: SHORTEST_CM,
    max: TALLEST_CM,
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
        <NumberInput {...common} label={t("height.stated")} value={stated} onChange={setStated} />
        <NumberInput
          {...common}
          label={t("height.matched")}
          value={matched}
          onChange={setMatched}
        />
      </div>
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
          {t("do.complete.height")}
        </Button>
        {exceptions}
      </div>
    </form>
  );
}

const isHeight = (value: number | string): value is number =>
  typeof value === "number" && value >= SHORTEST_CM && value <= TALLEST_CM;
