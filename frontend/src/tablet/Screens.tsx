/** The frame of every screen, and the choice of the screen. */
import { SegmentedControl } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import type { ConsentForm } from "@shared/api/records";
import type { TabletState } from "@shared/api/types";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { Icon } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect } from "react";
import { useSweep } from "./drafts/useSweep";
import { useTexts } from "./i18n";
import classes from "./Screens.module.css";
import { Consent } from "./screens/Consent";
import { Finished } from "./screens/Finished";
import { FormScreen } from "./screens/FormScreen";
import { Held } from "./screens/Held";
import { Reading } from "./screens/Reading";
import { Waiting } from "./screens/Waiting";
import { STATE_KEY } from "./useTabletState";

interface ScreensProps {
  readonly state: TabletState;
  readonly connected: boolean;
  readonly refresh: () => void;
}

export function Screens({ state, connected, refresh }: ScreensProps): JSX.Element {
  const { t, setLanguage, language } = useTexts();
  useSweep(state, connected);
  useEffect(() => {
    const spoken = state.language === "de" ? "de" : "en";
    if (spoken !== language) setLanguage(spoken);
  });
  return (
    <div className={classes.page}>
      <header className={classes.bar}>
        <Mark size={24} />
        {state.simulated && <span className={classes.simulated}>{t("bar.simulated")}</span>}
        {!connected && (
          <span className={classes.offline} role="status">
            <Icon name="alert" size={18} />
            {t("bar.offline")}
          </span>
        )}
        <LanguageChoice state={state} />
      </header>
      <main className={classes.content}>
        <Screen state={state} refresh={refresh} />
      </main>
    </div>
  );
}

function Screen({ state, refresh }: Omit<ScreensProps, "connected">): JSX.Element {
  switch (state.screen) {
    case "held":
      return <Held />;
    case "consent":
      if (state.consent != null && asksMore(state.consent)) {
        return <Consent key={state.step_index} state={state} form={state.consent} />;
      }
      return <Reading key={state.step_index} state={state} screen="consent" />;
    case "instructions":
      return (
        <Reading key={`${state.screen} ${state.step_index}`} state={state} screen={state.screen} />
      );
    case "form":
      if (state.administration === null) return <Waiting state={state} />;
      return (
        <FormScreen
          key={state.administration.key}
          state={state}
          administration={state.administration}
          refresh={refresh}
        />
      );
    case "finished":
      return <Finished state={state} />;
    case "waiting":
      return <Waiting state={state} />;
  }
}

/** Whether a consent wants more than one press. */
const asksMore = (form: ConsentForm): boolean =>
  form.signature !== "none" || form.statements.length > 0;

function LanguageChoice({ state }: { readonly state: TabletState }): JSX.Element | null {
  const { t } = useTexts();
  const queries = useQueryClient();
  const choose = useMutation({
    mutationFn: tablet.setLanguage,
    // The words change at once; the server's texts follow.
    onMutate: (language) =>
      queries.setQueryData<TabletState>(STATE_KEY, (known) => known && { ...known, language }),
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  if (state.languages.length < 2 || state.screen === "finished") return null;
  return (
    <SegmentedControl
      aria-label={t("bar.language")}
      size="sm"
      value={state.language}
      onChange={(language) => choose.mutate(language)}
      data={state.languages.map((value) => ({ value, label: LANGUAGE_NAMES[value] ?? value }))}
    />
  );
}
