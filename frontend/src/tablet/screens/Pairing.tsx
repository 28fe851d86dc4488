/**
 * The first screen: enter the pairing code by large on-screen keys, by keyboard, or by the QR link.
 */
import { Button, Loader, Text, Title } from "@mantine/core";
import { Unreachable } from "@shared/api/request";
import { writtenCode } from "@shared/pairingCode";
import { CodeEntry } from "@shared/ui/CodeEntry";
import { Mark } from "@shared/ui/Mark";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Pairing.module.css";

interface PairingProps {
  readonly ended: boolean;
  readonly pending: boolean;
  readonly error: unknown;
  readonly onCode: (code: string) => void;
}

export function Pairing({ ended, pending, error, onCode }: PairingProps): JSX.Element {
  const { t } = useTexts();
  const [characters, setCharacters] = useState("");
  return (
    <main className={classes.page}>
      <Mark size={40} />
      <div>
        <Title order={1}>{t("pair.title")}</Title>
        <Text c="dimmed" maw={560} mt={6} style={{ textWrap: "balance" }}>
          {t("pair.lead")}
        </Text>
      </div>
      <CodeEntry
        characters={characters}
        disabled={pending}
        label={t("pair.code")}
        deleteLabel={t("pair.delete")}
        onCharacters={setCharacters}
        onCode={onCode}
      />
      <div className={classes.state}>
        <PairingState
          {...{ ended, pending, error }}
          onRetry={() => onCode(writtenCode(characters))}
        />
      </div>
    </main>
  );
}

interface PairingStateProps {
  readonly ended: boolean;
  readonly pending: boolean;
  readonly error: unknown;
  readonly onRetry: () => void;
}

function PairingState({ ended, pending, error, onRetry }: PairingStateProps): JSX.Element | null {
  const { t } = useTexts();
  if (pending) {
    return (
      <Button variant="transparent" fullWidth leftSection={<Loader size="sm" />}>
        {t("pair.connecting")}
      </Button>
    );
  }
  if (error instanceof Unreachable) return <Failure error={error} onRetry={onRetry} />;
  // A rejected code stays rejected: another one has to be entered, so there is nothing to retry.
  if (error !== null) return <Failure error={error} />;
  if (!ended) return null;
  return (
    <Notice tone="warn" title={t("pair.ended.title")}>
      {t("pair.ended.body")}
    </Notice>
  );
}
