/** Tracking software that sends to this server: doors, sources, and how to connect. */
import { Title } from "@mantine/core";
import type { Tracker, Trackers } from "@shared/api/trackers";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { type Key, useTexts } from "../../i18n";
import { Recordings } from "../../performer/Recordings";
import { usePermissions } from "../../permissions";
import { performersQuery, trackersQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { useTitle } from "../../ui/page";
import { DoorCard } from "./DoorCard";
import { HowToConnect } from "./HowToConnect";
import { SourceSection } from "./SourceSection";
import classes from "./Trackers.module.css";

export function TrackersPage(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("trackers.title"));
  const query = useQuery(trackersQuery);
  return (
    <>
      <Link href="/equipment" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("equipment.title")}
      </Link>
      <Title order={1}>{t("trackers.title")}</Title>
      <p className={classes.lead}>{t("trackers.lead")}</p>
      <Loaded query={query}>{(all) => <Parts all={all} />}</Loaded>
    </>
  );
}

function Parts({ all }: { readonly all: Trackers }): JSX.Element {
  const { t } = useTexts();
  const canOpen = usePermissions()("openDoor");
  const { data: skeletons } = useQuery(performersQuery);
  const isAnyOpen = all.doors.some((door) => door.is_open);
  return (
    <>
      <section aria-labelledby="doors">
        <Title order={2} id="doors">
          {t("trackers.doors")}
        </Title>
        {!canOpen && <p className={classes.by}>{t("trackers.mayNot")}</p>}
        <div className={classes.doors}>
          {all.doors.map((door) => (
            <DoorCard key={door.door} door={door} interfaces={all.interfaces} />
          ))}
        </div>
      </section>
      <section className={classes.sources} aria-labelledby="sources">
        <Title order={2} id="sources">
          {t("trackers.sources")}
        </Title>
        {all.turned_away > 0 && (
          <Notice tone="warn" title={t("trackers.turnedAway", { count: all.turned_away })} />
        )}
        {wornTwice(all).map(([limb, own]) => (
          <Notice key={limb} tone="warn" title={t("trackers.twice")}>
            {t("trackers.twice.body", {
              limb: t(`joint.${limb}` as Key),
              trackers: own.map((one) => one.name).join(", "),
            })}
          </Notice>
        ))}
        <Recordings all={skeletons?.recordings ?? []} />
        {all.sources.length === 0 ? (
          <EmptyState icon="plug" title={t(isAnyOpen ? "trackers.empty" : "trackers.shut")}>
            {t(isAnyOpen ? "trackers.empty.body" : "trackers.shut.body")}
          </EmptyState>
        ) : (
          all.sources.map((source) => (
            <SourceSection
              key={`${source.door} ${source.address} ${source.name}`}
              source={source}
              limbs={all.limbs}
              skeletons={skeletons}
            />
          ))
        )}
      </section>
      <HowToConnect doors={all.doors} />
    </>
  );
}

/** The limbs on which more than one tracker is worn whose source is sending. */
function wornTwice(all: Trackers): readonly (readonly [string, readonly Tracker[]])[] {
  // Two senders of one name, which are said elsewhere, have the same trackers.
  const worn = new Map<string, Tracker>();
  for (const { door, name, is_silent, trackers } of all.sources) {
    for (const one of is_silent ? [] : trackers) {
      worn.set(JSON.stringify([door, name, one.name]), one);
    }
  }
  const own = [...worn.values()];
  return all.limbs
    .map((limb) => [limb, own.filter((one) => one.limb === limb)] as const)
    .filter(([, several]) => several.length > 1);
}
