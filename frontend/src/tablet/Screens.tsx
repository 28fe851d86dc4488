/** What is in the bar of every screen, and the choice of which screen is shown. */
import { Button, SegmentedControl } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import type { ConsentForm } from "@shared/api/records";
import type { TabletState } from "@shared/api/types";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import callForHelpClasses from "./CallForHelp.module.css";
import { type Refusal, useRefusal } from "./drafts/refusal";
import { useSweep } from "./drafts/useStored";
import { Frame } from "./Frame";
import classes from "./Frame.module.css";
import { useTexts } from "./i18n";
import { Consent } from "./screens/Consent";
import { FormScreen } from "./screens/FormScreen";
import { AnsweredElsewhere, Finished, OnHold, Refused, Waiting } from "./screens/IdleScreens";
import { Reading } from "./screens/Reading";
import { languageOf } from "./stateInPage";
import { applySize, chosenSize, nextSize } from "./textSize";
import { STATE_KEY } from "./useTabletState";

interface ScreensProps {
  readonly state: TabletState;
  readonly connected: boolean;
  readonly show: (next: TabletState) => void;
  readonly refresh: () => void;
}

export function Screens({ state, connected, show, refresh }: ScreensProps): JSX.Element {
  const { t, setLanguage, language } = useTexts();
  const refusal = useRefusal(state);
  const content = useFocusOnNewScreen(state, refusal);
  useSweep(state, connected);
  useEffect(() => {
    const spoken = languageOf(state);
    if (spoken !== language) setLanguage(spoken);
  });
  return (
    <Frame
      simulated={state.simulated ? t("bar.simulated") : null}
      offline={connected ? null : t("bar.offline")}
      tools={
        <>
          <CallForHelp state={state} connected={connected} />
          <TextSizeButton />
          <LanguageChoice state={state} />
        </>
      }
      content={content}
    >
      <Screen {...{ state, connected, show, refresh, refusal }} />
    </Frame>
  );
}

/**
 * Focus the heading of a new screen, so that screen readers and keyboard users start at the top.
 */
function useFocusOnNewScreen(state: TabletState, refusal: Refusal) {
  const { screen, step_index, administration } = state;
  const content = useRef<HTMLElement>(null);
  const shown = `${isRefused(state, refusal) ? "refused" : screen} ${step_index} ${administration?.key ?? ""}`;
  const before = useRef(shown);
  useEffect(() => {
    if (before.current === shown) return;
    before.current = shown;
    content.current?.focus({ preventScroll: true });
  }, [shown]);
  return content;
}

/**
 * Whether the participant's latest word is a refusal, even if the server does not know of it yet.
 */
const isRefused = ({ screen }: TabletState, { waiting }: Refusal): boolean =>
  screen !== "finished" && (screen === "refused" || waiting?.refused === true);

interface ScreenProps extends ScreensProps {
  readonly refusal: Refusal;
}

function Screen({ state, connected, show, refresh, refusal }: ScreenProps): JSX.Element {
  if (isRefused(state, refusal)) return <Refused connected={connected} refusal={refusal} />;
  const refuse = () => refusal.setRefused(true);
  switch (state.screen) {
    case "held":
      return <OnHold />;
    case "consent":
      if (state.consent != null && needsMoreThanOnePress(state.consent)) {
        return (
          <Consent key={state.step_index} state={state} form={state.consent} onRefuse={refuse} />
        );
      }
      return <Reading key={state.step_index} state={state} screen="consent" onRefuse={refuse} />;
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
          show={show}
          refresh={refresh}
        />
      );
    case "in_headset":
    case "oral":
      return <AnsweredElsewhere state={state} where={state.screen} />;
    case "finished":
      return <Finished state={state} />;
    case "refused":
    case "waiting":
      return <Waiting state={state} />;
  }
}

function TextSizeButton(): JSX.Element {
  const { t } = useTexts();
  const [size, setSize] = useState(chosenSize);
  useEffect(() => applySize(size), [size]);
  return (
    <Button
      size="sm"
      variant="default"
      aria-label={t("bar.textSize", { percent: Math.round(size * 100) })}
      title={t("bar.textSize", { percent: Math.round(size * 100) })}
      onClick={() => setSize(nextSize)}
    >
      <span aria-hidden="true" className={classes.letters}>
        A<span>A</span>
      </span>
    </Button>
  );
}

/** Whether a consent needs more than one press: statements to tick, or a signature. */
const needsMoreThanOnePress = (form: ConsentForm): boolean =>
  form.signature !== "none" || form.statements.length > 0;

function LanguageChoice({ state }: { readonly state: TabletState }): JSX.Element | null {
  const { t } = useTexts();
  const queries = useQueryClient();
  const choose = useMutation({
    mutationFn: tablet.setLanguage,
    // The page's own texts change immediately; the server's texts follow.
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

interface CallForHelpProps {
  readonly state: TabletState;
  readonly connected: boolean;
}

/**
 * The bar that is always shown: one press calls the experimenter, and it confirms that the call has
 * arrived.
 */
function CallForHelp({ state, connected }: CallForHelpProps): JSX.Element | null {
  const { t } = useTexts();
  const queries = useQueryClient();
  const call = useMutation({
    mutationFn: tablet.help,
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  if (state.screen === "finished") return null;
  return (
    <div className={callForHelpClasses.help}>
      <span className={callForHelpClasses.confirmation} role="status">
        {state.help_asked ? t("help.called") : call.isError || !connected ? t("help.failed") : ""}
      </span>
      {connected && (
        <Button
          size="sm"
          variant={state.help_asked ? "subtle" : "default"}
          color="gray"
          loading={call.isPending}
          leftSection={<Icon name={state.help_asked ? "close" : "help"} size={18} />}
          onClick={() => call.mutate(!state.help_asked)}
        >
          {t(state.help_asked ? "help.takeBack" : "help.call")}
        </Button>
      )}
    </div>
  );
}
