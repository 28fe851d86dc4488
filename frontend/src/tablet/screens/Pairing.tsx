/**
 * The first screen: enter the pairing code by large on-screen keys, by keyboard, or by the QR link.
 */
import { Button, Loader, Text, Title } from "@mantine/core";
import { Unreachable } from "@shared/api/request";
import { Icon } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { CODE_LENGTH, codeCharacters, writtenCode } from "../pairing";
import classes from "./Pairing.module.css";

const ROWS = ["1234567890", "QWERTYUIOP", "ASDFGHJKL", "ZXCVBNM"] as const;

interface PairingProps {
  readonly ended: boolean;
  readonly pending: boolean;
  readonly error: unknown;
  readonly onCode: (code: string) => void;
}

export function Pairing({ ended, pending, error, onCode }: PairingProps): JSX.Element {
  const { t } = useTexts();
  const [characters, setCharacters] = useState("");
  const enter = (typed: string) => {
    const next = codeCharacters(typed);
    setCharacters(next);
    if (next.length === CODE_LENGTH && next !== characters) onCode(writtenCode(next));
  };
  return (
    <main className={classes.page}>
      <Mark size={40} />
      <div>
        <Title order={1}>{t("pair.title")}</Title>
        <Text c="dimmed" maw={560} mt={6} style={{ textWrap: "balance" }}>
          {t("pair.lead")}
        </Text>
      </div>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (characters.length === CODE_LENGTH) onCode(writtenCode(characters));
        }}
      >
        <input
          className={classes.code}
          aria-label={t("pair.code")}
          // The keys below are the keyboard; the system's own would cover half of the screen.
          inputMode="none"
          autoComplete="off"
          autoCapitalize="characters"
          spellCheck={false}
          placeholder="···-···"
          value={writtenCode(characters)}
          readOnly={pending}
          onChange={(event) => enter(event.currentTarget.value)}
        />
      </form>
      <Keys
        disabled={pending}
        onKey={(key) => enter(characters + key)}
        onDelete={() => enter(characters.slice(0, -1))}
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

interface KeysProps {
  readonly disabled: boolean;
  readonly onKey: (key: string) => void;
  readonly onDelete: () => void;
}

function Keys({ disabled, onKey, onDelete }: KeysProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.keys}>
      {ROWS.map((row) => (
        <div key={row} className={classes.row}>
          {[...row].map((key) => (
            <button
              key={key}
              type="button"
              className={classes.key}
              disabled={disabled}
              onClick={() => onKey(key)}
            >
              {key}
            </button>
          ))}
          {row === ROWS[3] && (
            <button
              type="button"
              className={`${classes.key} ${classes.wide}`}
              aria-label={t("pair.delete")}
              disabled={disabled}
              onClick={onDelete}
            >
              <Icon name="backspace" size={28} />
            </button>
          )}
        </div>
      ))}
    </div>
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
