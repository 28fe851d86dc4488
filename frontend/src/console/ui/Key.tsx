import type { JSX } from "react";
import classes from "./ui.module.css";

/** A key of the keyboard, as printed on it. */
export function Key({ name }: { readonly name: string }): JSX.Element {
  return <kbd className={classes.key}>{name}</kbd>;
}
