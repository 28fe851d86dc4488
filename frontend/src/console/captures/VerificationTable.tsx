/** The verification in numbers, and the movement on each avatar to download. */
import { Button, Table } from "@mantine/core";
import {
  type AvatarWalker,
  type Capture,
  captures,
  type MovementFormat,
  type Verification,
  type Walker,
} from "@shared/api/captures";
import { decimals, number } from "@shared/format";
import { MOVEMENT_FORMATS } from "@shared/session/registries.generated";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useDownload } from "../pages/study/useDownload";
import { statureOf } from "./avatars";
import classes from "./Verification.module.css";
import { liftsOf } from "./VerificationSummary";

interface VerificationTableProps {
  readonly capture: Capture;
  readonly verification: Verification;
}

const COLUMNS = [
  ...(["body", "leg", "ratio", "length", "height"] as const),
  ...(["start", "contact", "lifts", "slide"] as const),
];

/** A raise of less is not worth a sentence. */
const SHOWN_M = 0.0005;

export function VerificationTable({ capture, verification }: VerificationTableProps): JSX.Element {
  const { t } = useTexts();
  const download = useDownload();
  const stem = capture.file_name.replace(/\.[^.]+$/, "");
  return (
    <>
      {/* Wider than the page on a small screen, where it scrolls. */}
      <section className={classes.frame} aria-label={t("verify.table")}>
        <Table verticalSpacing="xs" horizontalSpacing="sm">
          <Table.Thead>
            <Table.Tr>
              {COLUMNS.map((column) => (
                <Table.Th key={column}>{t(`verify.column.${column}`)}</Table.Th>
              ))}
              <Table.Th>{t("verify.column.export")}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody className="numbers">
            <BodyRow walker={verification.source} avatar={null} />
            {verification.avatars.map((avatar) => (
              <BodyRow key={avatar.name} walker={avatar} avatar={avatar}>
                <Exports
                  name={avatar.name}
                  onExport={(format) =>
                    void download.start(
                      captures.exportUrl(capture.id, avatar.name, format, verification.lock_feet),
                      `${stem}-${avatar.name}.${format}`,
                    )
                  }
                />
              </BodyRow>
            ))}
          </Table.Tbody>
        </Table>
      </section>
      {download.state.phase === "failed" && <Failure error={download.state.error} />}
      <p className={classes.soft}>{t("verify.table.caption")}</p>
      <Raised avatars={verification.avatars} />
    </>
  );
}

/** What keeping the avatars' feet above the floor costs. */
function Raised({ avatars }: { readonly avatars: readonly AvatarWalker[] }): JSX.Element {
  const { t, language } = useTexts();
  const centimetres = (metres: number) => number(100 * metres, language, 1);
  const avatarOf = (name: string) =>
    t("capture.avatar.cm", { value: number(statureOf(name), language) });
  const raised = avatars
    .filter(({ floor }) => floor.raised_m >= SHOWN_M)
    .map(({ name, floor }) =>
      t("verify.raised.one", {
        avatar: avatarOf(name),
        most: centimetres(floor.raised_m),
        mean: centimetres(floor.mean_raised_m),
        sunk: centimetres(floor.sunk_m),
      }),
    );
  const lifted = avatars
    .filter(({ floor }) => (floor.lifted_m ?? 0) >= SHOWN_M)
    .map(({ name, floor }) =>
      t("verify.lifted.one", {
        avatar: avatarOf(name),
        most: centimetres(floor.lifted_m ?? 0),
        sunk: centimetres(floor.sunk_m),
      }),
    );
  return (
    <>
      {raised.length > 0 && (
        <p className={classes.soft}>{t("verify.raised", { told: raised.join("; ") })}</p>
      )}
      {lifted.length > 0 && (
        <p className={classes.soft}>{t("verify.lifted", { told: lifted.join("; ") })}</p>
      )}
    </>
  );
}

interface BodyRowProps {
  readonly walker: Walker;
  readonly avatar: AvatarWalker | null;
  readonly children?: ReactNode;
}

function BodyRow({ walker, avatar, children }: BodyRowProps): JSX.Element {
  const { t, language } = useTexts();
  const metres = (value: number | null | undefined) =>
    value == null ? "–" : decimals(value, language, 3);
  const ratio = (value: number | null | undefined) =>
    value == null ? null : (
      <span className={classes.sub}>
        {t("verify.ratio", { value: decimals(value, language, 3) })}
      </span>
    );
  const start = (side: "left" | "right") =>
    metres(walker.toe_paths.find((path) => path.side === side)?.start_height_m);
  return (
    <Table.Tr>
      <Table.Th scope="row">
        {avatar === null
          ? t("verify.source")
          : t("capture.avatar.cm", { value: number(statureOf(avatar.name), language) })}
      </Table.Th>
      <Table.Td>{metres(walker.leg_length_m)}</Table.Td>
      <Table.Td>{avatar === null ? "1" : decimals(avatar.leg_ratio, language, 3)}</Table.Td>
      <Table.Td>
        {metres(walker.mean_stride_length_m)}
        {ratio(avatar?.length_ratio)}
      </Table.Td>
      <Table.Td>
        {metres(walker.mean_step_height_m)}
        {ratio(avatar?.height_ratio)}
      </Table.Td>
      <Table.Td>
        <Pair left={start("left")} right={start("right")} />
      </Table.Td>
      <Table.Td>
        <Pair
          left={metres(meanContact(walker, "left"))}
          right={metres(meanContact(walker, "right"))}
        />
      </Table.Td>
      <Table.Td>
        <Pair {...liftsOf(walker)} />
        {avatar !== null && !avatar.lifts_agree && (
          <span className={classes.differs}>
            <Icon name="alert" size={14} />
          </span>
        )}
      </Table.Td>
      <Table.Td className={classes.slide ?? ""}>
        <Slide walker={walker} avatar={avatar} metres={metres} />
      </Table.Td>
      <Table.Td>{children}</Table.Td>
    </Table.Tr>
  );
}

interface PairProps {
  readonly left: number | string;
  readonly right: number | string;
}

/** The left foot's value above the right foot's. */
function Pair({ left, right }: PairProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <span className={classes.of}>
        {left} <span>{t("verify.left")}</span>
      </span>
      <span className={classes.of}>
        {right} <span>{t("verify.right")}</span>
      </span>
    </>
  );
}

interface SlideProps {
  readonly walker: Walker;
  readonly avatar: AvatarWalker | null;
  readonly metres: (value: number | null) => string;
}

function Slide({ walker, avatar, metres }: SlideProps): JSX.Element {
  const { t, language } = useTexts();
  if (avatar === null) return <>{metres(walker.foot_slide_m_s)}</>;
  const { slide_before_m_s, lowered_m, out_of_reach } = avatar;
  return (
    <>
      {metres(avatar.slide_m_s)}
      {slide_before_m_s !== null && (
        <span className={classes.sub}>
          {t("verify.slide.before", { before: metres(slide_before_m_s) })}
        </span>
      )}
      {lowered_m !== null && lowered_m >= 0.000_05 && (
        <span className={classes.sub}>
          {t("verify.lowered", { centimetres: number(100 * lowered_m, language) })}
        </span>
      )}
      {out_of_reach !== null && out_of_reach > 0 && (
        <span className={classes.sub}>{t("verify.reach", { count: out_of_reach })}</span>
      )}
    </>
  );
}

interface ExportsProps {
  readonly name: string;
  readonly onExport: (format: MovementFormat) => void;
}

function Exports({ name, onExport }: ExportsProps): JSX.Element {
  const { t, language } = useTexts();
  const avatar = t("capture.avatar.cm", { value: number(statureOf(name), language) });
  return (
    <span className={classes.exports}>
      {MOVEMENT_FORMATS.map((format) => (
        <Button
          key={format}
          size="compact-xs"
          variant="default"
          aria-label={t("verify.export", { avatar, format: t(`movement.format.${format}`) })}
          leftSection={<Icon name="download" size={13} />}
          onClick={() => onExport(format)}
        >
          {t(`movement.format.${format}`)}
        </Button>
      ))}
    </span>
  );
}

function meanContact({ strides }: Walker, side: "left" | "right"): number | null {
  const heights = strides.filter((one) => one.side === side).map((one) => one.contact_height_m);
  return heights.length === 0 ? null : heights.reduce((sum, one) => sum + one, 0) / heights.length;
}
