/**
 * The frame of every screen: the bar, and the content below it.
 *
 * It is also drawn before React is there (`early`), so nothing in it may use a hook.
 */
import { Icon } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import type { JSX, ReactNode, Ref } from "react";
import classes from "./Frame.module.css";

interface FrameProps {
  /** What is said of a simulated session, and of a lost connection; null: nothing. */
  readonly simulated: string | null;
  readonly offline: string | null;
  readonly tools: ReactNode;
  readonly content?: Ref<HTMLElement>;
  readonly children: ReactNode;
}

export function Frame(props: FrameProps): JSX.Element {
  const { simulated, offline } = props;
  return (
    <div className={classes.page}>
      <header className={classes.bar}>
        <Mark size={24} />
        {simulated !== null && <span className={classes.simulated}>{simulated}</span>}
        {offline !== null && (
          <span className={classes.offline} role="status">
            <Icon name="alert" size={18} />
            {offline}
          </span>
        )}
        <div className={classes.tools}>{props.tools}</div>
      </header>
      <main className={classes.content} ref={props.content} tabIndex={-1}>
        {props.children}
      </main>
    </div>
  );
}
