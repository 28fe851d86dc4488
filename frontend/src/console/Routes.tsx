/** Which page an address of the console leads to, and who may see it. */
import type { Account } from "@shared/api/types";
import { type JSX, lazy } from "react";
import { Route, Switch } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { SessionPage } from "./cockpit/SessionPage";
import { isReadable } from "./frame/places";
import { PageNotFound, RequirePermission } from "./pages/NoPermission";
import { StudiesPage } from "./pages/Studies";
import { StudyPage } from "./pages/study/StudyPage";
import classes from "./Shell.module.css";

// Loaded when they are opened: the first page and the cockpit do not wait for them.
const InstrumentPage = lazy(async () => ({
  default: (await import("./instruments/InstrumentPage")).InstrumentPage,
}));
const InstrumentsPage = lazy(async () => ({
  default: (await import("./instruments/InstrumentsPage")).InstrumentsPage,
}));
const ConsentPage = lazy(async () => ({
  default: (await import("./pages/consent/ConsentPage")).ConsentPage,
}));
const EquipmentPage = lazy(async () => ({
  default: (await import("./pages/equipment/EquipmentPage")).EquipmentPage,
}));
const NetworkPage = lazy(async () => ({
  default: (await import("./pages/network/NetworkPage")).NetworkPage,
}));
const PeoplePage = lazy(async () => ({
  default: (await import("./pages/people/PeoplePage")).PeoplePage,
}));
const TrackersPage = lazy(async () => ({
  default: (await import("./pages/trackers/TrackersPage")).TrackersPage,
}));
const ReplayPage = lazy(async () => ({
  default: (await import("./replay/ReplayPage")).ReplayPage,
}));
const OutageSheet = lazy(async () => ({
  default: (await import("./pages/outage/OutageSheet")).OutageSheet,
}));
const CapturePage = lazy(async () => ({
  default: (await import("./captures/CapturePage")).CapturePage,
}));
const CapturesPage = lazy(async () => ({
  default: (await import("./captures/CapturesPage")).CapturesPage,
}));
const BodiesPage = lazy(async () => ({
  default: (await import("./bodies/BodiesPage")).BodiesPage,
}));
const BodyPage = lazy(async () => ({
  default: (await import("./bodies/BodyPage")).BodyPage,
}));
const AvatarsPage = lazy(async () => ({
  default: (await import("./avatarEditor/AvatarsPage")).AvatarsPage,
}));
const AvatarPage = lazy(async () => ({
  default: (await import("./avatarEditor/AvatarPage")).AvatarPage,
}));
const WalkingPage = lazy(async () => ({
  default: (await import("./walking/WalkingPage")).WalkingPage,
}));
const WalkingModelPage = lazy(async () => ({
  default: (await import("./walking/ModelPage")).ModelPage,
}));
const EditStudyPage = lazy(async () => ({
  default: (await import("./editor/EditorPage")).EditStudyPage,
}));
const NewStudyEditor = lazy(async () => ({
  default: (await import("./editor/EditorPage")).NewStudyEditor,
}));
const NewStudyPage = lazy(async () => ({
  default: (await import("./editor/NewStudyPage")).NewStudyPage,
}));
const EditInstrumentPage = lazy(async () => ({
  default: (await import("./instruments/InstrumentEditor")).EditInstrumentPage,
}));
const NewInstrumentPage = lazy(async () => ({
  default: (await import("./instruments/InstrumentEditor")).NewInstrumentPage,
}));
const StoragePage = lazy(async () => ({
  default: (await import("./storage/StoragePage")).StoragePage,
}));

const HelpPage = lazy(async () => ({
  default: (await import("./help/HelpPage")).HelpPage,
}));

export function Routes({ account }: { readonly account: Account }): JSX.Element {
  // As it was written: the router's own address is decoded where that is possible.
  const [address] = useHashLocation();
  if (!isReadable(address)) return <Nowhere />;
  return (
    <Switch>
      <Route path="/sessions/:id/consent">
        {({ id }) => (
          <RequirePermission permission="run">
            <ConsentPage key={id} id={id} />
          </RequirePermission>
        )}
      </Route>
      <Route path="/sessions/:id/outage">
        {({ id }) => (
          <RequirePermission permission="run">
            <OutageSheet key={id} id={id} />
          </RequirePermission>
        )}
      </Route>
      <Route path="/sessions/:id/:place">
        {({ id, place }) =>
          place.startsWith("replay") ? (
            <ReplayPage key={id} id={id} />
          ) : (
            <SessionPage key={id} id={id} />
          )
        }
      </Route>
      <Route path="/equipment">
        <div className={classes.main}>
          <EquipmentPage />
        </div>
      </Route>
      <Route path="/trackers">
        <div className={classes.main}>
          <TrackersPage />
        </div>
      </Route>
      <Route path="/captures">
        <div className={classes.main}>
          <CapturesPage />
        </div>
      </Route>
      <Route path="/captures/:id/:tab?">
        {({ id, tab }) => (
          <div className={classes.main}>
            <CapturePage key={id} id={id} tab={tab} />
          </div>
        )}
      </Route>
      <Route path="/bodies">
        <div className={classes.main}>
          <BodiesPage />
        </div>
      </Route>
      <Route path="/bodies/:hash">
        {({ hash }) => (
          <div className={classes.main}>
            <BodyPage key={hash} hash={hash} />
          </div>
        )}
      </Route>
      <Route path="/avatars">
        <div className={classes.main}>
          <AvatarsPage />
        </div>
      </Route>
      <Route path="/avatars/:key/:version?">
        {({ key, version }) => (
          <AvatarPage key={`${key} ${version}`} avatarKey={key} version={version} />
        )}
      </Route>
      <Route path="/walking/models/:id">
        {({ id }) => (
          <div className={classes.main}>
            <WalkingModelPage key={id} id={id} />
          </div>
        )}
      </Route>
      <Route path="/walking/:tab?">
        {({ tab }) => (
          <div className={classes.main}>
            <WalkingPage tab={tab} />
          </div>
        )}
      </Route>
      <Route path="/sessions/:id">{({ id }) => <SessionPage key={id} id={id} />}</Route>
      <Route path="/network">
        <RequirePermission permission="network">
          <div className={classes.main}>
            <NetworkPage />
          </div>
        </RequirePermission>
      </Route>
      <Route path="/help/:name?/:heading?">
        {({ name, heading }) => (
          <div className={classes.main}>
            <HelpPage name={name} heading={heading} />
          </div>
        )}
      </Route>
      <Route path="/storage">
        <RequirePermission permission="storage">
          <div className={classes.main}>
            <StoragePage />
          </div>
        </RequirePermission>
      </Route>
      <Route path="/people/:tab?">
        {({ tab }) => (
          <RequirePermission permission="people">
            <div className={classes.main}>
              <PeoplePage account={account} tab={tab} />
            </div>
          </RequirePermission>
        )}
      </Route>
      <Route path="/new">
        <RequirePermission permission="design">
          <div className={classes.main}>
            <NewStudyPage />
          </div>
        </RequirePermission>
      </Route>
      <Route path="/new/:from/:name?">
        {({ from, name }) => (
          <RequirePermission permission="design">
            <NewStudyEditor key={`${from} ${name}`} from={from} name={name} />
          </RequirePermission>
        )}
      </Route>
      <Route path="/instruments">
        <div className={classes.main}>
          <InstrumentsPage />
        </div>
      </Route>
      <Route path="/instruments/new">
        <RequirePermission permission="design">
          <NewInstrumentPage />
        </RequirePermission>
      </Route>
      <Route path="/instruments/:name/edit">
        {({ name }) => (
          <RequirePermission permission="design">
            <EditInstrumentPage key={name} name={name} />
          </RequirePermission>
        )}
      </Route>
      <Route path="/instruments/:name/:tab?">
        {({ name, tab }) => (
          <div className={classes.main}>
            <InstrumentPage name={name} tab={tab} />
          </div>
        )}
      </Route>
      <Route path="/studies/:key/edit">
        {({ key }) => (
          <RequirePermission permission="design">
            <EditStudyPage key={key} studyKey={key} />
          </RequirePermission>
        )}
      </Route>
      <Route path="/studies/:key/:tab?">
        {({ key, tab }) => (
          <div className={classes.main}>
            <StudyPage studyKey={key} tab={tab} />
          </div>
        )}
      </Route>
      <Route path="/">
        <div className={classes.main}>
          <StudiesPage />
        </div>
      </Route>
      <Route>
        <Nowhere />
      </Route>
    </Switch>
  );
}

const Nowhere = (): JSX.Element => (
  <div className={classes.main}>
    <PageNotFound />
  </div>
);
