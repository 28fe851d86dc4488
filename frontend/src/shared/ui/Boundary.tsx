/**
 * What stands in the place of a part that could not be loaded, or that has failed; without it the
 * whole page would be empty.
 */
import { Button, Loader } from "@mantine/core";
import {
  Component,
  type JSX,
  type ReactNode,
  useLayoutEffect,
  useState,
  useSyncExternalStore,
} from "react";
import { type KeyOf, useTranslations } from "../i18n/i18n";
import classes from "./Boundary.module.css";
import { Notice } from "./Notice";
import type { pageEn } from "./pageTexts";
import {
  dismiss,
  isShownInPlace,
  isUnloaded,
  reasonFound,
  reload,
  showInPlace,
  subscribe,
} from "./unloaded";

interface BoundaryProps {
  /** What the part shows, such as an address: another one is tried anew. */
  readonly place?: string;
  readonly children: ReactNode;
}

interface BoundaryState {
  readonly error: unknown;
  readonly failed: boolean;
  readonly place: string | undefined;
}

/** Catches what its children throw, lazily loaded ones included, and says it in their place. */
export class Boundary extends Component<BoundaryProps, BoundaryState> {
  override state: BoundaryState = { error: null, failed: false, place: this.props.place };

  static getDerivedStateFromError(error: unknown): Partial<BoundaryState> {
    return { error, failed: true };
  }

  static getDerivedStateFromProps(
    { place }: BoundaryProps,
    before: BoundaryState,
  ): Partial<BoundaryState> | null {
    return place === before.place ? null : { error: null, failed: false, place };
  }

  override render(): ReactNode {
    const { failed, error } = this.state;
    if (!failed) return this.props.children;
    return isUnloaded(error) ? <UnloadedNotice /> : <BrokenNotice error={error} />;
  }
}

const useTexts = () => useTranslations<KeyOf<typeof pageEn>>();

/** Says where a part would be why it could not be loaded. */
export function UnloadedNotice(): JSX.Element {
  // Before anything is drawn, or the bar would say the same beside it for a moment.
  useLayoutEffect(showInPlace, []);
  return (
    <div className={classes.inPlace}>
      <Reason />
    </div>
  );
}

/** Says beside the page that a part could not be loaded, unless it is said in its place. */
export function UnloadedBar(): JSX.Element | null {
  const { t } = useTexts();
  const reason = useSyncExternalStore(subscribe, reasonFound);
  const isElsewhere = useSyncExternalStore(subscribe, isShownInPlace);
  if (reason === null || isElsewhere) return null;
  return (
    <div className={classes.bar}>
      <Reason>
        <Button size="xs" variant="default" onClick={dismiss}>
          {t("page.later")}
        </Button>
      </Reason>
    </div>
  );
}

function Reason({ children }: { readonly children?: ReactNode }): JSX.Element {
  const { t } = useTexts();
  const reason = useSyncExternalStore(subscribe, reasonFound);
  if (reason === null) {
    return (
      <span role="status">
        <Loader size="xs" /> {t("page.looking")}
      </span>
    );
  }
  return (
    <Notice
      tone="bad"
      title={t(`page.${reason}`)}
      remedy={t(`page.${reason}.remedy`)}
      actions={
        <>
          <ReloadButton />
          {children}
        </>
      }
    >
      {t(`page.${reason}.body`)}
    </Notice>
  );
}

function ReloadButton(): JSX.Element {
  const { t } = useTexts();
  const [isAsking, setAsking] = useState(false);
  return (
    <Button
      size="xs"
      loading={isAsking}
      onClick={() => {
        setAsking(true);
        void reload().finally(() => setAsking(false));
      }}
    >
      {t("page.reload")}
    </Button>
  );
}

function BrokenNotice({ error }: { readonly error: unknown }): JSX.Element {
  const { t } = useTexts();
  const message = error instanceof Error ? error.message : String(error);
  return (
    <div className={classes.inPlace}>
      <Notice
        tone="bad"
        title={t("page.broken")}
        remedy={t("page.broken.remedy")}
        actions={<ReloadButton />}
      >
        {t("page.broken.body", { message })}
      </Notice>
    </div>
  );
}
