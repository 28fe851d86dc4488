/** Header and routes of the signed-in console. */
import { ActionIcon, Button, useComputedColorScheme, useMantineColorScheme } from "@mantine/core";
import type { Role } from "@shared/api/people";
import type { Account } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import { Mark } from "@shared/ui/Mark";
import type { JSX } from "react";
import { Link, Route, Router, Switch } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { useSignInAgain } from "./account";
import { SessionPage } from "./cockpit/SessionPage";
import { EditStudyPage, NewStudyEditor } from "./editor/EditorPage";
import { NewStudyPage } from "./editor/NewStudyPage";
import { type Key, useTexts } from "./i18n";
import { EditInstrumentPage, NewInstrumentPage } from "./instruments/InstrumentEditor";
import { InstrumentPage } from "./instruments/InstrumentPage";
import { InstrumentsPage } from "./instruments/InstrumentsPage";
import { type Act, may } from "./may";
import { AccountMenu } from "./pages/account/AccountMenu";
import { ConsentPage } from "./pages/consent/ConsentPage";
import { EquipmentPage } from "./pages/equipment/EquipmentPage";
import { Only } from "./pages/NotForRole";
import { NetworkPage } from "./pages/network/NetworkPage";
import { PeoplePage } from "./pages/people/PeoplePage";
import { StudiesPage } from "./pages/Studies";
import { StudyPage } from "./pages/study/StudyPage";
import classes from "./Shell.module.css";

export function Shell({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  useSignInAgain();
  return (
    <Router hook={useHashLocation}>
      <button type="button" className={classes.skip} onClick={focusMain}>
        {t("app.skip")}
      </button>
      <nav className={classes.header} aria-label={t("app.name")}>
        <Link href="/" className={classes.brand ?? ""}>
          <Mark size={26} />
          {t("app.name")}
        </Link>
        <div className={classes.tools}>
          <Places role={account.role} />
          <LanguageButton />
          <AppearanceButton />
          <AccountMenu account={account} />
        </div>
      </nav>
      <main id="main" tabIndex={-1}>
        <Switch>
          <Route path="/sessions/:id/consent">
            {({ id }) => (
              <Only act="run">
                <ConsentPage key={id} id={id} />
              </Only>
            )}
          </Route>
          <Route path="/equipment">
            <div className={classes.main}>
              <EquipmentPage />
            </div>
          </Route>
          <Route path="/sessions/:id">{({ id }) => <SessionPage key={id} id={id} />}</Route>
          <Route path="/network">
            <Only act="network">
              <div className={classes.main}>
                <NetworkPage />
              </div>
            </Only>
          </Route>
          <Route path="/people/:tab?">
            {({ tab }) => (
              <Only act="people">
                <div className={classes.main}>
                  <PeoplePage account={account} tab={tab} />
                </div>
              </Only>
            )}
          </Route>
          <Route path="/new">
            <Only act="design">
              <div className={classes.main}>
                <NewStudyPage />
              </div>
            </Only>
          </Route>
          <Route path="/new/:from/:name?">
            {({ from, name }) => (
              <Only act="design">
                <NewStudyEditor key={`${from} ${name}`} from={from} name={name} />
              </Only>
            )}
          </Route>
          <Route path="/instruments">
            <div className={classes.main}>
              <InstrumentsPage />
            </div>
          </Route>
          <Route path="/instruments/new">
            <Only act="design">
              <NewInstrumentPage />
            </Only>
          </Route>
          <Route path="/instruments/:name/edit">
            {({ name }) => (
              <Only act="design">
                <EditInstrumentPage key={name} name={name} />
              </Only>
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
              <Only act="design">
                <EditStudyPage key={key} studyKey={key} />
              </Only>
            )}
          </Route>
          <Route path="/studies/:key/:tab?">
            {({ key, tab }) => (
              <div className={classes.main}>
                <StudyPage studyKey={key} tab={tab} />
              </div>
            )}
          </Route>
          <Route>
            <div className={classes.main}>
              <StudiesPage />
            </div>
          </Route>
        </Switch>
      </main>
    </Router>
  );
}

/** The address after `#` belongs to the router, so skipping moves the focus itself. */
function focusMain(): void {
  document.getElementById("main")?.focus();
}

interface Place {
  readonly href: string;
  readonly icon: IconName;
  readonly name: Key;
  /** Shown to those who may do it; to everybody where there is none. */
  readonly act?: Act;
}

const PLACES: readonly Place[] = [
  { href: "/instruments", icon: "form", name: "instruments.title" },
  { href: "/equipment", icon: "headset", name: "equipment.title" },
  { href: "/network", icon: "link", name: "network.title", act: "network" },
  { href: "/people", icon: "people", name: "people.title", act: "people" },
];

function Places({ role }: { readonly role: Role }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      {PLACES.filter(({ act }) => act === undefined || may(role, act)).map((place) => (
        <Button
          key={place.href}
          component={Link}
          href={place.href}
          variant="subtle"
          color="gray"
          fw={450}
          size="compact-sm"
          leftSection={<Icon name={place.icon} size={16} />}
        >
          {t(place.name)}
        </Button>
      ))}
    </>
  );
}

function LanguageButton(): JSX.Element {
  const { t, language, setLanguage } = useTexts();
  return (
    <Button
      variant="subtle"
      color="gray"
      fw={450}
      size="compact-sm"
      lang={language === "en" ? "de" : "en"}
      onClick={() => setLanguage(language === "en" ? "de" : "en")}
    >
      {t("app.language")}
    </Button>
  );
}

function AppearanceButton(): JSX.Element {
  const { t } = useTexts();
  const { setColorScheme } = useMantineColorScheme();
  const scheme = useComputedColorScheme("light");
  const other = scheme === "light" ? "dark" : "light";
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      size="lg"
      aria-label={t(`app.theme.${other}`)}
      onClick={() => setColorScheme(other)}
    >
      <Icon name={other === "dark" ? "moon" : "sun"} />
    </ActionIcon>
  );
}
