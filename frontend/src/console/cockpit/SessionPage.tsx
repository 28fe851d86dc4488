/** The cockpit: everything one experimenter needs while a participant is in the headset. */
import { useDisclosure } from "@mantine/hooks";
import type { SessionView } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useRef, useState } from "react";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { AfterWithdrawal } from "../rights/AfterWithdrawal";
import { Tour } from "../tour/Tour";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { RecordDrawer } from "../ui/RecordDrawer";
import { AlarmDrawer } from "./alarms/AlarmDrawer";
import { titleKey, useAlarms } from "./alarms/alarms";
import { SignalStrip } from "./alarms/SignalStrip";
import { TelemetryCard } from "./alarms/TelemetryCard";
import { AvatarPanel, isChangeable } from "./avatar/AvatarPanel";
import { BodyPanel, knowsBody } from "./body/BodyPanel";
import classes from "./Cockpit.module.css";
import { CompanionPanel } from "./companion/CompanionPanel";
import { DevicesPanel } from "./devices/DevicesPanel";
import { Header } from "./Header";
import { hasMovement, LiveCard } from "./live3d/LiveCard";
import { StartAnyway } from "./preflight/OverrideDialog";
import { PreflightBody, PreflightCard } from "./preflight/PreflightCard";
import { usePreflight } from "./preflight/usePreflight";
import { EventDrawer } from "./record/EventDrawer";
import { NotesPanel } from "./record/NotesPanel";
import { PhaseTable } from "./record/PhaseTable";
import { ReceiptDrawer } from "./record/ReceiptDrawer";
import { ScoresPanel } from "./record/ScoresPanel";
import { SuggestionsPanel } from "./record/SuggestionsPanel";
import { Timeline } from "./record/Timeline";
import { RoadPanel } from "./road/RoadPanel";
import { currentStep, isBlocked, primaryAction, type Reasoned } from "./session/action";
import { CommandFailure } from "./session/CommandFailure";
import { KeyboardHelp, useKeys } from "./session/keys";
import { type Send, useSession } from "./session/useSession";
import { CurrentStep } from "./step/CurrentStep";
import { HeldCard, RefusedCard } from "./step/HeldCard";
import { OperatorEntry } from "./step/OperatorEntry";
import { ReasonDialog } from "./step/ReasonDialog";
import { LabTrackersPanel } from "./trackers/LabTrackersPanel";

/** Only one of them is ever allowed. Pausing does not require a reason: it has to be quick. */
const PAUSING = ["pause", "resume"] as const;

export function SessionPage({ id }: { readonly id: string }): JSX.Element {
  const live = useSession(id);
  const can = usePermissions();
  return (
    <Loaded query={live.query}>
      {(session) => <Cockpit session={can("run") ? session : readOnly(session)} live={live} />}
    </Loaded>
  );
}

/** The session for somebody who may watch but not send commands. */
const readOnly = (session: SessionView): SessionView => ({ ...session, allowed: [] });

interface CockpitProps {
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
}

function Cockpit({ session, live: direct }: CockpitProps): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const [asking, setAsking] = useState<Reasoned | null>(null);
  const [log, logs] = useDisclosure();
  const [receipt, receipts] = useDisclosure();
  const [help, helps] = useDisclosure();
  const [entry, entries] = useDisclosure();
  const [history, histories] = useDisclosure();
  const [list, lists] = useDisclosure();
  const [avatar, avatars] = useDisclosure();
  const isPlanned = can("run") && session.status === "planned";
  const flight = usePreflight(session, direct, isPlanned || list);
  // A start checks the pre-flight list first; every other command is sent directly.
  const send: Send = (command, onDone) =>
    command.type === "start" ? void flight.start() : direct.send(command, onDone);
  const live = { ...direct, send, sending: direct.sending || flight.looking };
  const alarms = useAlarms(session, live.store, live.storage, live.failing);
  const worst = alarms.on[0];
  const isStaged = hasMovement(session);
  const overPicture = useRef<HTMLDivElement>(null);
  const ended = session.ended_at !== null;
  // Visible in the tab's title while another tab is in front.
  useTitle(
    worst?.severity === "critical"
      ? `▲ ${t(titleKey(worst))} · ${session.participant_code}`
      : session.participant_code,
  );
  const openReason = (type: Reasoned) => {
    if (session.allowed.includes(type)) setAsking(type);
  };
  useKeys({
    primary: () => {
      const action = primaryAction(session);
      if (action !== null && !isBlocked(session, action)) live.send(action.command);
    },
    pause: () => {
      const type = PAUSING.find((one) => session.allowed.includes(one));
      if (type !== undefined) live.send({ type });
    },
    redo: () => openReason("redo"),
    skip: () => openReason("skip"),
    note: () => document.getElementById("note")?.focus(),
    log: logs.toggle,
    help: helps.toggle,
    alarms: histories.toggle,
    avatar: () => (session.allowed.includes("change_avatar") ? avatars.open() : undefined),
    checks: () => (isPlanned || ended || !can("run") ? undefined : lists.toggle()),
    step: `${session.current?.index} ${session.current?.status}`,
  });
  return (
    <div className={classes.cockpit} data-staged={isStaged || undefined}>
      <Header
        session={session}
        feed={live.feed}
        onChecks={isPlanned || ended || !can("run") ? undefined : lists.open}
        onReceipt={session.status === "planned" ? undefined : receipts.open}
        onLog={logs.open}
        onHelp={helps.open}
      />
      <SignalStrip session={session} alarms={alarms} onHistory={histories.open} />
      <Timeline session={session} />
      <div className={classes.centre} data-tour="centre">
        <div className={isStaged ? classes.fold : classes.open}>
          {session.simulated && (
            <Notice
              tone="sim"
              title={t(session.time_scale === 1 ? "simulated.session.real" : "simulated.session", {
                scale: session.time_scale,
              })}
            />
          )}
          {session.kind === "expert" && <Notice tone="info" title={t("expert.session")} />}
          {!can("run") && <Notice tone="info" icon="info" title={t("read.only")} />}
          {ended && can("rights") && <AfterWithdrawal session={session} send={live.send} />}
          <CommandFailure live={live} />
          <div className={isStaged ? classes.stage : classes.open}>
            <div ref={overPicture} className={classes.overPicture}>
              {session.refusal !== null ? (
                <RefusedCard refusal={session.refusal} onReasonNeeded={openReason} />
              ) : session.held !== null ? (
                <HeldCard held={session.held} onReasonNeeded={openReason} />
              ) : (
                <CurrentStep
                  session={session}
                  live={live}
                  isReady={flight.isClear}
                  onReasonNeeded={openReason}
                  onEnterAnswers={entries.open}
                />
              )}
            </div>
            {isStaged && <LiveCard session={session} store={live.store} cover={overPicture} />}
          </div>
          {isPlanned && <PreflightCard session={session} flight={flight} />}
        </div>
        <TelemetryCard session={session} store={live.store} />
        {ended && <PhaseTable session={session} />}
      </div>
      <aside className={classes.side} data-tour="side" aria-label={t("side.label")}>
        {!ended && can("run") && <DevicesPanel session={session} />}
        {!ended && can("run") && <LabTrackersPanel session={session} />}
        {!ended && can("run") && <CompanionPanel session={session} />}
        <RoadPanel session={session} />
        {!ended && isChangeable(session) && (
          <AvatarPanel
            session={session}
            live={live}
            opened={avatar}
            onOpen={avatars.open}
            onClose={avatars.close}
          />
        )}
        {!ended && can("run") && knowsBody(session) && <BodyPanel session={session} live={live} />}
        {session.kind === "expert" && <SuggestionsPanel session={session} />}
        <NotesPanel session={session} send={live.send} sending={live.sending} />
        <ScoresPanel session={session} />
      </aside>
      <StartAnyway session={session} live={direct} flight={flight} />
      <RecordDrawer title={t("preflight.open")} opened={list} onClose={lists.close}>
        <PreflightBody session={session} flight={flight} />
      </RecordDrawer>
      <ReasonDialog type={asking} session={session} live={live} onClose={() => setAsking(null)} />
      <ReceiptDrawer session={session} opened={receipt} onClose={receipts.close} />
      <EventDrawer session={session} opened={log} onClose={logs.close} />
      <AlarmDrawer session={session} opened={history} onClose={histories.close} />
      <KeyboardHelp opened={help} onClose={helps.close} />
      <Tour />
      <OperatorEntry
        session={session}
        step={currentStep(session)}
        opened={entry}
        onClose={entries.close}
      />
    </div>
  );
}
