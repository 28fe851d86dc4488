import { Modal } from "@mantine/core";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

/** A key of the keyboard, as printed on it. */
export function Key({ name }: { readonly name: string }): JSX.Element {
  return <kbd className={classes.key}>{name}</kbd>;
}

export interface KeyboardHelpProps {
  readonly opened: boolean;
  readonly onClose: () => void;
}

interface KeyListProps extends KeyboardHelpProps {
  /** Each group of keys with its meaning. */
  readonly keys: readonly (readonly [names: readonly string[], meaning: string])[];
  readonly namesClass?: string | undefined;
}

/** The list of all keys of a page. */
export function KeyList({ opened, onClose, keys, namesClass }: KeyListProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("keys.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <dl className={classes.keys}>
        {keys.map(([names, meaning]) => (
          <div key={names.join(" ")} style={{ display: "contents" }}>
            <dt className={namesClass}>
              {names.map((name) => (
                <Key key={name} name={name} />
              ))}
            </dt>
            <dd>{meaning}</dd>
          </div>
        ))}
      </dl>
      <Link href="/help/operators-tour" onClick={onClose}>
        {t("helpPages.all")}
      </Link>
    </Modal>
  );
}
