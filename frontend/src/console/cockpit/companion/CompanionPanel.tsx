/** The performer whom the participant sees in the headset: chosen, given a body and a place. */
import { Button, Checkbox, NativeSelect, NumberInput } from "@mantine/core";
import {
  type CompanionPlace,
  type CompanionWish,
  companions,
  type SessionCompanion,
} from "@shared/api/companion";
import type { SessionView } from "@shared/api/types";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { titleOf as titleOfBody } from "../../bodies/names";
import { useBodyChoice } from "../../bodyView/BodyChoice";
import { avatarOf, STATURE_LIMITS, statureOf } from "../../captures/avatars";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { titleOf } from "../../performer/WatchPanel";
import { sessionCompanionQuery } from "../../queries";
import cockpit from "../Cockpit.module.css";
import live from "../Live.module.css";
import { hiddenBecause } from "../session/action";
import { ClosedDoor, useIsDoorClosed } from "../trackers/ClosedDoor";
import classes from "./CompanionPanel.module.css";

const PLACES: readonly CompanionPlace[] = ["ahead_left", "ahead_right", "left", "right"];
const PLAIN = "plain";
const NOBODY = "";

type Performer = Pick<CompanionWish, "door" | "source" | "skeleton">;

/** Nothing is shown in a lab in which nobody performs, and nobody is chosen. */
export function CompanionPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const { data: shown } = useQuery(sessionCompanionQuery(session.id));
  if (shown === undefined || (shown.companion === null && shown.choices.length === 0)) return <></>;
  return (
    <section aria-label={t("companion.title")}>
      <h2 className={cockpit.sectionTitle}>{t("companion.title")}</h2>
      {shown.companion === null ? (
        <p className={live.soft}>
          {t("companion.help")} {t("companion.consent")}
        </p>
      ) : (
        <InUse session={session} shown={shown} />
      )}
      <Choice session={session} shown={shown} />
      <Link href="/trackers" className={live.soft ?? ""}>
        {t("lab.page")}
      </Link>
    </section>
  );
}

function InUse({ session, shown }: ChoiceProps): JSX.Element {
  const { t, language } = useTexts();
  const { companion, headset, body, latency_ms, latency_p95_ms, stored, waiting_lost } = shown;
  const isStill = body != null && body.state !== "ready";
  const isSilent = body?.state === "absent" || body?.state === "silent";
  const door = companion?.door ?? null;
  const isClosed = useIsDoorClosed(door, isSilent);
  const one = (value: number) => decimals(value, language, 1);
  const others = body?.others ?? [];
  const listed = [...(body?.missing ?? []), ...(body?.problems ?? [])].join(", ");
  return (
    <>
      <output className={live.status}>
        <Icon name={headset === "seen" && !isStill ? "check" : "info"} size={14} />
        {headset === "seen"
          ? t(isStill ? "companion.now.still" : "companion.now.seen")
          : headset === "hidden"
            ? t(`companion.hidden.${hiddenBecause(session, companion?.in_tasks ?? false)}`)
            : t("companion.now.away")}
      </output>
      {isClosed && door !== null && <ClosedDoor door={door} />}
      {!isClosed && body != null && body.state !== "ready" && body.state !== "refused" && (
        <Notice tone="warn" title={t(`companion.body.${body.state}`, { listed })} />
      )}
      {others.length > 0 && (
        <Notice tone="warn" title={t("companion.others")}>
          {t("companion.others.body", {
            address: body?.address ?? "",
            others: others.join(", "),
          })}
        </Notice>
      )}
      {waiting_lost > 0 && (
        <Notice tone="bad" title={t("companion.gaveUp", { count: waiting_lost })} />
      )}
      <dl className={`${live.figures} numbers`}>
        {latency_ms != null && latency_p95_ms != null && (
          <>
            <dt>{t("companion.latency")}</dt>
            <dd>
              {t("companion.latency.value", {
                median: one(latency_ms),
                p95: one(latency_p95_ms),
              })}
            </dd>
          </>
        )}
        {stored > 0 && (
          <>
            <dt>{t("companion.stored")}</dt>
            <dd>{number(stored, language, 0)}</dd>
          </>
        )}
      </dl>
    </>
  );
}

interface ChoiceProps {
  readonly session: SessionView;
  readonly shown: SessionCompanion;
}

/** What is chosen is shown only when it is sent: each change is on the session's record. */
function Choice({ session, shown }: ChoiceProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const bodies = useBodyChoice(true);
  const [changes, setChanges] = useState<Partial<CompanionWish>>({});
  const choose = useMutation({
    mutationFn: (wish: CompanionWish | null) => companions.choose(session.id, wish),
    onSuccess: (now) => {
      queries.setQueryData(sessionCompanionQuery(session.id).queryKey, now);
      setChanges({});
    },
  });
  const before = shown.companion;
  const performers = performersOf(shown);
  const wish = wished(before, changes, bodies.hash);
  const change = (more: Partial<CompanionWish>) => setChanges({ ...changes, ...more });
  return (
    <div className={classes.form}>
      <NativeSelect
        size="xs"
        label={t("companion.performer")}
        value={wish === null ? NOBODY : keyOf(wish)}
        data={[
          ...(before === null ? [{ value: NOBODY, label: t("companion.nobody") }] : []),
          ...performers.map((one) => ({
            value: keyOf(one),
            label: one.is_silent
              ? t("companion.silentPerformer", { name: titleOf(one) })
              : titleOf(one),
          })),
        ]}
        onChange={({ currentTarget }) => {
          const one = performers.find((each) => keyOf(each) === currentTarget.value);
          if (one === undefined) setChanges({});
          else change({ door: one.door, source: one.source, skeleton: one.skeleton });
        }}
      />
      {wish !== null && (
        <>
          <div className={classes.row}>
            <Stature stature={wish.stature} onStature={(stature) => change({ stature })} />
            <NativeSelect
              size="xs"
              label={t("companion.body")}
              value={wish.humanoid ?? PLAIN}
              data={[
                ...bodies.bodies.map((one) => ({
                  value: one.content_hash,
                  label: titleOfBody(one),
                })),
                { value: PLAIN, label: t("companion.body.plain") },
              ]}
              onChange={({ currentTarget: { value } }) =>
                change({ humanoid: value === PLAIN ? null : value })
              }
            />
          </div>
          <NativeSelect
            size="xs"
            label={t("companion.place")}
            value={wish.place}
            data={PLACES.map((value) => ({ value, label: t(`companion.place.${value}`) }))}
            onChange={({ currentTarget }) =>
              change({ place: currentTarget.value as CompanionPlace })
            }
          />
          <Checkbox
            size="xs"
            label={t("companion.inTasks")}
            description={t("companion.inTasks.hint")}
            checked={wish.in_tasks}
            onChange={({ currentTarget }) => change({ in_tasks: currentTarget.checked })}
          />
        </>
      )}
      {choose.error !== null && <Failure error={choose.error} />}
      <div className={classes.actions}>
        {wish !== null && (before === null || Object.keys(changes).length > 0) && (
          <Button size="xs" loading={choose.isPending} onClick={() => choose.mutate(wish)}>
            {t(before === null ? "companion.show" : "companion.apply")}
          </Button>
        )}
        {before !== null && (
          <Button
            size="xs"
            variant="default"
            disabled={choose.isPending}
            onClick={() => choose.mutate(null)}
          >
            {t("companion.remove")}
          </Button>
        )}
      </div>
    </div>
  );
}

interface StatureProps {
  readonly stature: string;
  readonly onStature: (stature: string) => void;
}

/** What is typed stays as it is until the field is left, also while it is no stature yet. */
function Stature({ stature, onStature }: StatureProps): JSX.Element {
  const { t } = useTexts();
  const [typed, setTyped] = useState<number | string | null>(null);
  return (
    <NumberInput
      size="xs"
      label={t("companion.stature")}
      {...STATURE_LIMITS}
      suffix=" cm"
      decimalScale={1}
      value={typed ?? statureOf(stature)}
      onChange={(value) => {
        setTyped(value);
        const named = avatarOf(value);
        if (named !== null) onStature(named);
      }}
      onBlur={() => setTyped(null)}
    />
  );
}

const keyOf = ({ door, source, skeleton }: Performer): string =>
  JSON.stringify([door, source, skeleton]);

/** Those who send or have sent, and the chosen one also while nobody knows them. */
function performersOf({ companion, choices }: SessionCompanion): SessionCompanion["choices"] {
  if (companion === null || choices.some((one) => keyOf(one) === keyOf(companion))) return choices;
  const { door, source, skeleton } = companion;
  return [...choices, { door, source, skeleton, is_silent: true }];
}

/** What is shown with the changes; null before a performer is chosen. */
function wished(
  before: SessionCompanion["companion"],
  changes: Partial<CompanionWish>,
  humanoid: string | null,
): CompanionWish | null {
  const { door, source, skeleton } = { ...before, ...changes };
  if (door === undefined || source === undefined || skeleton === undefined) return null;
  const { stature, place, in_tasks } = { ...USUAL, ...before, ...changes };
  const worn = before === null ? humanoid : before.humanoid;
  return {
    ...{ door, source, skeleton, stature, place, in_tasks },
    humanoid: changes.humanoid === undefined ? worn : changes.humanoid,
  };
}

const USUAL = { stature: "170cm", place: "ahead_right", in_tasks: false } as const;
