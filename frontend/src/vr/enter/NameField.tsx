/** The name of this device, to tell it from others: typed once and kept by the browser. */
import { TextInput } from "@mantine/core";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { givenName, keepName, LONGEST_NAME } from "../selftest/givenName";
import classes from "./Enter.module.css";

export function NameField(): JSX.Element {
  const { t } = useTexts();
  const [name, setName] = useState(() => givenName());
  return (
    <TextInput
      className={classes.name ?? ""}
      label={t("enter.name")}
      description={t("enter.name.hint")}
      autoComplete="off"
      maxLength={LONGEST_NAME}
      value={name}
      onChange={(event) => {
        setName(event.currentTarget.value);
        keepName(event.currentTarget.value);
      }}
    />
  );
}
