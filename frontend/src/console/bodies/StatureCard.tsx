/**
 * One body in the three statures of Degen et al. 2022, and beside it how a recorded walk changes on
 * them: what the paper prints, and what was computed for a capture of the lab.
 */
import { Anchor, Select, Table, Title } from "@mantine/core";
import type { CaptureListed } from "@shared/api/captures";
import { captures } from "@shared/api/captures";
import { decimals } from "@shared/format";
import { useQueries, useQuery } from "@tanstack/react-query";
import { type JSX, useMemo, useState } from "react";
import { Link } from "wouter";
import { BodyViewer, type RecordedWalk } from "../bodyView/BodyViewer";
import { PAPER_AVATARS, statureOf } from "../captures/avatars";
import { capturesQuery } from "../captures/queries";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { ScrollBox } from "../ui/tables";
import classes from "./Bodies.module.css";

const STATURES_M = PAPER_AVATARS.map((avatar) => statureOf(avatar) / 100);
/** The choice of the walk that the server generates, for labs without a capture. */
const GENERATED = "generated";
/** Stride lengths and lifts that the paper prints for them (its figure 9), centimetres. */
const PRINTED = [
  { length: 110, height: 16 },
  { length: 150, height: 20 },
  { length: 165, height: 22 },
] as const;

export function StatureCard({ hash }: { readonly hash: string }): JSX.Element {
  const { t } = useTexts();
  const listed = useQuery(capturesQuery);
  const [chosen, setChosen] = useState<string | null>(null);
  const usable = (listed.data?.captures ?? []).filter((one) => one.has_skeleton);
  const capture =
    chosen === GENERATED ? undefined : (usable.find(({ id }) => id === chosen) ?? usable[0]);
  const recorded = useWalk(capture);
  return (
    <section className={classes.section} aria-labelledby="three-statures">
      <Title order={2} id="three-statures">
        {t("bodies.statures")}
      </Title>
      <p className={classes.soft}>{t("bodies.statures.lead")}</p>
      <div className={classes.beside}>
        <BodyViewer
          hash={hash}
          name={t("bodies.statures")}
          staturesM={STATURES_M}
          firstSide="front"
          isLabelled
          recorded={recorded}
        />
        <Loaded query={listed}>
          {() => <Steps usable={usable} capture={capture} onChoose={setChosen} />}
        </Loaded>
      </div>
    </section>
  );
}

/** The capture on the three statures; undefined for none, and where it cannot be put on them. */
function useWalk(capture: CaptureListed | undefined): RecordedWalk | undefined {
  const queries = useQueries({
    queries: PAPER_AVATARS.map((avatar) => ({
      queryKey: ["captures", capture?.id, "three-statures", avatar],
      queryFn: () => captures.onAvatar(capture?.id ?? "", avatar, false),
      enabled: capture !== undefined,
      staleTime: Number.POSITIVE_INFINITY,
    })),
    combine: (all) => ({
      isFailed: all.some(({ isError }) => isError),
      motions: all.flatMap(({ data }) => data ?? []),
    }),
  });
  const { isFailed, motions } = queries;
  const title = capture?.title;
  return useMemo(
    () =>
      title === undefined || isFailed
        ? undefined
        : { title, motions: motions.length === PAPER_AVATARS.length ? motions : null },
    [title, isFailed, motions],
  );
}

interface StepsProps {
  readonly usable: readonly CaptureListed[];
  /** Undefined for the generated walk. */
  readonly capture: CaptureListed | undefined;
  readonly onChoose: (id: string | null) => void;
}

function Steps({ usable, capture, onChoose }: StepsProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.steps}>
      <Select
        label={t("bodies.statures.capture")}
        data={[
          ...usable.map(({ id, title }) => ({ value: id, label: title })),
          { value: GENERATED, label: t("bodies.statures.generated") },
        ]}
        value={capture?.id ?? GENERATED}
        allowDeselect={false}
        onChange={onChoose}
      />
      <StepTable id={capture?.id ?? null} />
      {capture === undefined ? (
        <p className={classes.soft}>
          {t("bodies.statures.none")}{" "}
          <Anchor component={Link} href="/captures" size="sm" underline="always">
            {t("bodies.statures.upload")}
          </Anchor>
        </p>
      ) : (
        <Anchor component={Link} href={`/captures/${capture.id}/verification`} size="sm">
          {t("bodies.statures.all")}
        </Anchor>
      )}
    </div>
  );
}

function StepTable({ id }: { readonly id: string | null }): JSX.Element {
  const { t, language } = useTexts();
  const query = useQuery({
    queryKey: ["captures", id, "three-statures"],
    queryFn: () =>
      id === null
        ? captures.generatedVerification(PAPER_AVATARS)
        : captures.verification(id, PAPER_AVATARS, false),
  });
  const cm = (metres: number | null | undefined) =>
    metres == null ? "–" : decimals(100 * metres, language, 1);
  return (
    <ScrollBox label={t("bodies.statures.caption")}>
      <Table verticalSpacing="xs">
        <Table.Caption>{t("bodies.statures.caption")}</Table.Caption>
        <Table.Thead>
          <Table.Tr>
            <Table.Th rowSpan={2}>{t("bodies.statures.stature")}</Table.Th>
            <Table.Th colSpan={2}>{t("bodies.statures.length")}</Table.Th>
            <Table.Th colSpan={2}>{t("bodies.statures.height")}</Table.Th>
          </Table.Tr>
          <Table.Tr>
            <Table.Th>{t("bodies.statures.here")}</Table.Th>
            <Table.Th>{t("bodies.statures.printed")}</Table.Th>
            <Table.Th>{t("bodies.statures.here")}</Table.Th>
            <Table.Th>{t("bodies.statures.printed")}</Table.Th>
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody className="numbers">
          {PAPER_AVATARS.map((avatar, index) => {
            const own = query.data?.avatars.find(({ name }) => name === avatar);
            return (
              <Table.Tr key={avatar}>
                <Table.Th scope="row">
                  {t("capture.avatar.cm", { value: statureOf(avatar) })}
                </Table.Th>
                <Table.Td>{cm(own?.mean_stride_length_m)}</Table.Td>
                <Table.Td>{PRINTED[index]?.length}</Table.Td>
                <Table.Td>{cm(own?.mean_step_height_m)}</Table.Td>
                <Table.Td>{PRINTED[index]?.height}</Table.Td>
              </Table.Tr>
            );
          })}
        </Table.Tbody>
      </Table>
    </ScrollBox>
  );
}
