import { Button, CopyButton } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "./Network.module.css";

/** A text to type elsewhere, with a button that copies it. */
export function Copyable({ text }: { readonly text: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.copyable}>
      <code>{text}</code>
      <CopyButton value={text}>
        {({ copied, copy }) => (
          <Button
            size="compact-xs"
            variant="default"
            onClick={copy}
            aria-label={`${t(copied ? "action.copied" : "action.copy")}: ${text}`}
          >
            {t(copied ? "action.copied" : "action.copy")}
          </Button>
        )}
      </CopyButton>
    </span>
  );
}
