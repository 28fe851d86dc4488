/** A pairing code, entered by large on-screen keys or a keyboard; the last character sends it. */
import { type JSX, useEffect, useRef } from "react";
import { CODE_LENGTH, codeCharacters, writtenCode } from "../pairingCode";
import classes from "./CodeEntry.module.css";
import { Icon } from "./Icon";

const ROWS = ["1234567890", "QWERTYUIOP", "ASDFGHJKL", "ZXCVBNM"] as const;

interface CodeEntryProps {
  readonly characters: string;
  readonly disabled: boolean;
  readonly label: string;
  readonly deleteLabel: string;
  readonly onCharacters: (characters: string) => void;
  readonly onCode: (code: string) => void;
}

export function CodeEntry(props: CodeEntryProps): JSX.Element {
  const { characters, disabled, label, deleteLabel, onCharacters, onCode } = props;
  const enter = (typed: string) => {
    const next = codeCharacters(typed);
    onCharacters(next);
    if (next.length === CODE_LENGTH && next !== characters) onCode(writtenCode(next));
  };
  const field = useRef<HTMLInputElement>(null);
  // A keyboard types the code without a click; no keys of the system come up (see inputMode).
  useEffect(() => field.current?.focus(), []);
  return (
    <>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (characters.length === CODE_LENGTH) onCode(writtenCode(characters));
        }}
      >
        <input
          ref={field}
          className={classes.code}
          aria-label={label}
          // The keys below are the keyboard; the system's own would cover half of the screen.
          inputMode="none"
          autoComplete="off"
          autoCapitalize="characters"
          spellCheck={false}
          placeholder="···-···"
          value={writtenCode(characters)}
          readOnly={disabled}
          onChange={(event) => enter(event.currentTarget.value)}
        />
      </form>
      <Keys
        disabled={disabled}
        deleteLabel={deleteLabel}
        onKey={(key) => enter(characters + key)}
        onDelete={() => enter(characters.slice(0, -1))}
      />
    </>
  );
}

interface KeysProps {
  readonly disabled: boolean;
  readonly deleteLabel: string;
  readonly onKey: (key: string) => void;
  readonly onDelete: () => void;
}

function Keys({ disabled, deleteLabel, onKey, onDelete }: KeysProps): JSX.Element {
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
              aria-label={deleteLabel}
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
