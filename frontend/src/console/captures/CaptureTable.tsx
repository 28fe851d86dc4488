/**
 * The list of captures: what each one is, how long, and whether it can be transferred to an avatar.
 */
import { Button, Popover, Table } from "@mantine/core";
import type { CaptureListed } from "@shared/api/captures";
import { dateTime, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { nameOf } from "../account";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { ListTable } from "../ui/tables";
import classes from "./Captures.module.css";
import { useFormatName } from "./DropZone";
import { captureQuery } from "./queries";

interface CaptureTableProps {
  readonly captures: readonly CaptureListed[];
  readonly onDelete: ((capture: CaptureListed) => void) | null;
}

const COLUMNS = ["title", "format", "length", "skeleton", "by"] as const;

export function CaptureTable({ captures, onDelete }: CaptureTableProps): JSX.Element {
  const { t } = useTexts();
  return (
    <ListTable
      columns={COLUMNS.map((column) => t(`captures.column.${column}`))}
      hasActions={onDelete !== null}
    >
      {captures.map((capture) => (
        <Row key={capture.id} capture={capture} onDelete={onDelete} />
      ))}
    </ListTable>
  );
}

interface RowProps {
  readonly capture: CaptureListed;
  readonly onDelete: CaptureTableProps["onDelete"];
}

function Row({ capture, onDelete }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const formatName = useFormatName();
  const [file, companion] = [capture.file_name, capture.companion_name];
  const sub = [capture.title === file ? null : file, companion].filter((name) => name !== null);
  return (
    <Table.Tr>
      <Table.Td>
        <Link href={`/captures/${capture.id}`} className={classes.title ?? ""}>
          {capture.title}
        </Link>
        {sub.length > 0 && <span className={classes.sub}>{sub.join(" + ")}</span>}
      </Table.Td>
      <Table.Td>
        {formatName(capture.format)}
        <span className={classes.sub}>
          {t(`captures.kind.${capture.kind}`, { count: capture.tracks })}
        </span>
      </Table.Td>
      <Table.Td className="numbers">
        {t("captures.seconds", { value: number(capture.duration_s, language) })}
        <span className={classes.sub}>
          {t("captures.frames", {
            frames: number(capture.frames, language),
            rate: number(capture.rate_hz, language),
          })}
        </span>
      </Table.Td>
      <Table.Td>
        <HasSkeleton capture={capture} />
      </Table.Td>
      <Table.Td>
        {dateTime(capture.at, language)}
        <span className={classes.sub}>{t("captures.by", { by: nameOf(capture.by) })}</span>
      </Table.Td>
      {onDelete !== null && (
        <Table.Td className={classes.rowActions ?? ""}>
          <Button
            size="compact-sm"
            variant="subtle"
            color="gray"
            aria-label={t("captures.delete", { name: capture.title })}
            onClick={() => onDelete(capture)}
          >
            {t("captures.delete.short")}
          </Button>
        </Table.Td>
      )}
    </Table.Tr>
  );
}

function HasSkeleton({ capture }: { readonly capture: CaptureListed }): JSX.Element {
  const { t } = useTexts();
  if (capture.has_skeleton) {
    return (
      <span className={classes.yes}>
        <Icon name="body" size={16} />
        {t("captures.skeleton.yes")}
      </span>
    );
  }
  return (
    <span className={classes.no}>
      {t("captures.skeleton.no")}
      <ReasonPopover capture={capture} />
    </span>
  );
}

/** The reason is part of the capture itself, so it is fetched on request. */
function ReasonPopover({ capture }: { readonly capture: CaptureListed }): JSX.Element {
  const { t } = useTexts();
  const [opened, setOpened] = useState(false);
  const query = useQuery({ ...captureQuery(capture.id), enabled: opened });
  return (
    <Popover opened={opened} onChange={setOpened} width={340} withArrow shadow="md">
      <Popover.Target>
        <Button
          size="compact-xs"
          variant="subtle"
          aria-label={t("captures.skeleton.why.of", { name: capture.title })}
          onClick={() => setOpened(!opened)}
        >
          {t("captures.skeleton.why")}
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Loaded query={query}>{({ summary }) => <>{summary.no_skeleton}</>}</Loaded>
      </Popover.Dropdown>
    </Popover>
  );
}
