/**
 * A table of numbers that is edited like a spreadsheet, by mouse and by keyboard: arrows move,
 * Enter or a digit starts an edit, Enter takes it over, Escape leaves it. Space chooses a row.
 */
import { Icon } from "@shared/ui/Icon";
import {
  type JSX,
  type KeyboardEvent,
  type MouseEvent,
  useEffect,
  useId,
  useRef,
  useState,
} from "react";
import classes from "./NumberGrid.module.css";

export interface GridColumn {
  readonly key: string;
  readonly title: string;
  readonly unit: string;
  /** What its numbers can be. */
  readonly range: readonly [least: number, greatest: number];
}

export interface GridCell {
  readonly value: number;
  /** What it was in the version that the work started from, where that differs. */
  readonly before?: number | undefined;
  /** The name of the cell for people who do not see its row and column. */
  readonly label: string;
}

export interface GridRow {
  readonly key: string;
  readonly name: string;
  readonly code: string;
  readonly tags: readonly string[];
  readonly cells: readonly (GridCell | null)[];
}

export interface GridSection {
  readonly key: string;
  readonly title: string;
  readonly summary: string;
  readonly rows: readonly GridRow[];
}

interface NumberGridProps {
  readonly label: string;
  readonly columns: readonly GridColumn[];
  readonly sections: readonly GridSection[];
  readonly open: ReadonlySet<string>;
  readonly onOpen: (section: string, isOpen: boolean) => void;
  readonly selected: ReadonlySet<string>;
  readonly onSelect: (rows: readonly string[], isSelected: boolean) => void;
  readonly chosen: string | null;
  readonly onChoose: (row: string) => void;
  readonly onEdit: (row: string, column: string, value: number) => void;
  readonly isReadOnly: boolean;
  readonly format: (value: number) => string;
  readonly texts: {
    readonly name: string;
    readonly selection: string;
    readonly select: (name: string) => string;
    readonly was: (value: string) => string;
    readonly wrong: (column: GridColumn) => string;
  };
}

/** Column 0 chooses the row, column 1 names it; the numbers follow. */
interface Place {
  readonly row: string;
  readonly column: number;
}

const FIRST_NUMBER = 2;
const PAGE = 10;
/** With more columns than these the cells are narrower. */
const USUAL_COLUMNS = 6;
/** A section's own row has this prefix, so that it cannot be mistaken for an axis. */
const SECTION = "section ";

export function NumberGrid(props: NumberGridProps): JSX.Element {
  const { label, columns, sections, open, texts, selected, chosen, isReadOnly, format } = props;
  const lines = sections.flatMap((section) => [
    SECTION + section.key,
    ...(open.has(section.key) ? section.rows.map(({ key }) => key) : []),
  ]);
  const [wished, setPlace] = useState<Place>({ row: chosen ?? lines[0] ?? "", column: 0 });
  const [editing, setEditing] = useState<{ readonly text: string | null } | null>(null);
  const place = lines.includes(wished.row) ? wished : { row: lines[0] ?? "", column: 0 };
  const table = useRef<HTMLTableElement>(null);
  const takesFocus = useRef(false);
  useEffect(() => {
    if (!takesFocus.current || editing !== null) return;
    takesFocus.current = false;
    const cell = table.current?.querySelector<HTMLElement>("[data-here]");
    cell?.focus();
    cell?.scrollIntoView({ block: "nearest" });
  });
  const focusOn = (row: string, column: number) => {
    takesFocus.current = true;
    setEditing(null);
    setPlace({ row, column });
  };
  const goTo = (row: string, column: number) => {
    focusOn(row, column);
    if (!row.startsWith(SECTION)) props.onChoose(row);
  };
  const rowAt = (key: string) =>
    sections.flatMap(({ rows }) => rows).find((row) => row.key === key);
  const lineAt = (by: number) => {
    const at = lines.indexOf(place.row) + by;
    return lines[Math.min(Math.max(at, 0), lines.length - 1)] ?? place.row;
  };
  const move = (by: number) => goTo(lineAt(by), place.column);
  const startEdit = (text: string | null) => {
    const cell = rowAt(place.row)?.cells[place.column - FIRST_NUMBER];
    if (!isReadOnly && cell) setEditing({ text });
  };
  const commit = (value: number, by: number) => {
    props.onEdit(place.row, columns[place.column - FIRST_NUMBER]?.key ?? "", value);
    // The edited row stays the chosen one: what shows or tries a row shows what was just changed.
    focusOn(lineAt(by), place.column);
  };
  const select = () => {
    const section = sections.find(({ key }) => SECTION + key === place.row);
    const rows = section === undefined ? [place.row] : section.rows.map(({ key }) => key);
    props.onSelect(rows, !rows.every((row) => selected.has(row)));
  };
  const onKeyDown = (event: KeyboardEvent) => {
    if (editing !== null) return;
    const key = event.ctrlKey || event.metaKey ? `Ctrl+${event.key}` : event.key;
    const isSection = place.row.startsWith(SECTION);
    const section = place.row.slice(SECTION.length);
    const last = columns.length + FIRST_NUMBER - 1;
    const actions: Readonly<Record<string, () => void>> = {
      ArrowDown: () => move(1),
      ArrowUp: () => move(-1),
      PageDown: () => move(PAGE),
      PageUp: () => move(-PAGE),
      ArrowRight: () =>
        isSection ? props.onOpen(section, true) : goTo(place.row, Math.min(place.column + 1, last)),
      ArrowLeft: () =>
        isSection ? props.onOpen(section, false) : goTo(place.row, Math.max(place.column - 1, 0)),
      Home: () => goTo(place.row, 0),
      End: () => goTo(place.row, last),
      "Ctrl+Home": () => goTo(lines[0] ?? "", place.column),
      "Ctrl+End": () => goTo(lines.at(-1) ?? "", place.column),
      " ": select,
      Enter: () => (isSection ? props.onOpen(section, !open.has(section)) : startEdit(null)),
      F2: () => startEdit(null),
      "Ctrl+a": () =>
        props.onSelect(
          lines.filter((line) => !line.startsWith(SECTION)),
          true,
        ),
    };
    const action = actions[key];
    if (action !== undefined) action();
    else if (/^[-\d.,]$/.test(key)) startEdit(key);
    else return;
    event.preventDefault();
  };
  const onClick = (event: MouseEvent) => {
    if (!(event.target instanceof Element) || event.target.matches("input")) return;
    const cell = event.target.closest<HTMLElement>("[data-row]");
    const row = cell?.dataset.row;
    if (row === undefined) return;
    const column = Number(cell?.dataset.column ?? 0);
    goTo(row, column);
    const section = row.slice(SECTION.length);
    if (row.startsWith(SECTION)) props.onOpen(section, !open.has(section));
    else if (column === 0) props.onSelect([row], !selected.has(row));
    else if (event.detail === 2 && !isReadOnly && rowAt(row)?.cells[column - FIRST_NUMBER]) {
      setEditing({ text: null });
    }
  };
  const isHere = (row: string, column: number) => place.row === row && place.column === column;
  /** The attributes of a cell that can be reached with the arrows; one of them with Tab. */
  const reachable = (row: string, column: number) => ({
    tabIndex: isHere(row, column) ? 0 : -1,
    ...(isHere(row, column) ? { "data-here": "" } : {}),
    "data-row": row,
    "data-column": column,
  });
  return (
    <table
      ref={table}
      // biome-ignore lint/a11y/noNoninteractiveElementToInteractiveRole: a table whose sections open, with the keys of a spreadsheet, is a tree grid
      role="treegrid"
      aria-readonly={isReadOnly}
      aria-label={label}
      aria-multiselectable
      aria-rowcount={lines.length + 1}
      className={`${classes.table} numbers`}
      data-dense={columns.length > USUAL_COLUMNS || undefined}
      onKeyDown={onKeyDown}
      onClick={onClick}
    >
      <thead>
        <tr>
          <th scope="col">
            <span className="visually-hidden">{texts.selection}</span>
          </th>
          <th scope="col" className={classes.nameHead}>
            {texts.name}
          </th>
          {columns.map(({ key, title, unit }) => (
            <th key={key} scope="col">
              {title}
              <span className={classes.unit}>{unit}</span>
            </th>
          ))}
        </tr>
      </thead>
      {sections.map((section) => (
        <tbody key={section.key}>
          <tr className={classes.section} aria-level={1} aria-expanded={open.has(section.key)}>
            <td
              colSpan={columns.length + FIRST_NUMBER}
              {...sectionReach(reachable, section.key, place)}
            >
              <span className={classes.sectionTitle}>
                <Icon name={open.has(section.key) ? "down" : "forward"} size={15} />
                <span className={classes.titleText}>{section.title}</span>
                <span className={classes.summary}>{section.summary}</span>
              </span>
            </td>
          </tr>
          {open.has(section.key) &&
            section.rows.map((row) => (
              <tr
                key={row.key}
                aria-level={2}
                aria-selected={selected.has(row.key)}
                data-chosen={chosen === row.key || undefined}
              >
                <td
                  className={classes.mark}
                  {...reachable(row.key, 0)}
                  aria-label={texts.select(row.name)}
                >
                  <span className={classes.box}>
                    {selected.has(row.key) && <Icon name="check" size={13} />}
                  </span>
                </td>
                <th scope="row" className={classes.name} {...reachable(row.key, 1)}>
                  {row.name}
                  {row.tags.map((tag) => (
                    <span key={tag} className={classes.tag}>
                      {tag}
                    </span>
                  ))}
                </th>
                {row.cells.map((cell, at) => {
                  const column = at + FIRST_NUMBER;
                  const isEdited = editing !== null && isHere(row.key, column);
                  const isChanged = cell?.before !== undefined;
                  const itsColumn = columns[at];
                  return (
                    <td
                      key={columns[at]?.key}
                      {...reachable(row.key, column)}
                      data-changed={isChanged || undefined}
                      title={
                        cell?.before === undefined ? undefined : texts.was(format(cell.before))
                      }
                    >
                      {isEdited && cell !== null && itsColumn !== undefined ? (
                        <CellInput
                          label={cell.label}
                          wrong={texts.wrong(itsColumn)}
                          range={itsColumn.range}
                          initial={editing.text ?? String(cell.value)}
                          isTyped={editing.text !== null}
                          onCommit={commit}
                          onCancel={() => {
                            takesFocus.current = true;
                            setEditing(null);
                          }}
                        />
                      ) : cell === null ? (
                        ""
                      ) : (
                        format(cell.value)
                      )}
                    </td>
                  );
                })}
              </tr>
            ))}
        </tbody>
      ))}
    </table>
  );
}

/** A section has one cell, whichever column one comes from. */
const sectionReach = (
  reachable: (row: string, column: number) => object,
  section: string,
  place: Place,
) => reachable(SECTION + section, place.row === SECTION + section ? place.column : 0);

interface CellInputProps {
  readonly label: string;
  /** What to enter instead of a text, or of a number out of the range. */
  readonly wrong: string;
  readonly range: GridColumn["range"];
  readonly initial: string;
  /** Whether a digit started the edit: then it is continued, otherwise the number is replaced. */
  readonly isTyped: boolean;
  readonly onCommit: (value: number, by: number) => void;
  readonly onCancel: () => void;
}

function CellInput(props: CellInputProps): JSX.Element {
  const [text, setText] = useState(props.initial);
  const field = useRef<HTMLInputElement>(null);
  const isOver = useRef(false);
  const [isTried, setTried] = useState(false);
  const wrongId = useId();
  useEffect(() => {
    field.current?.focus();
    if (!props.isTyped) field.current?.select();
  }, [props.isTyped]);
  const value = text.trim() === "" ? Number.NaN : Number(text.trim().replace(",", "."));
  const [least, greatest] = props.range;
  const isInside = value >= least && value <= greatest;
  // A number that is begun, such as a minus, is no mistake yet.
  const isWrong = Number.isFinite(value) ? !isInside : isTried;
  const finish = (by: number) => {
    setTried(true);
    if (isOver.current || !isInside) return;
    isOver.current = true;
    props.onCommit(value, by);
  };
  const input = (
    <input
      ref={field}
      className={classes.input}
      aria-label={props.label}
      inputMode="decimal"
      aria-invalid={isWrong}
      aria-describedby={isWrong ? wrongId : undefined}
      value={text}
      onChange={(event) => setText(event.currentTarget.value)}
      onBlur={() => {
        if (isInside) finish(0);
        else if (!isOver.current) props.onCancel();
      }}
      onKeyDown={(event) => {
        event.stopPropagation();
        if (event.key === "Enter") finish(event.shiftKey ? -1 : 1);
        else if (event.key === "Escape") {
          isOver.current = true;
          props.onCancel();
        } else return;
        event.preventDefault();
      }}
    />
  );
  return (
    <span className={classes.field}>
      {input}
      {isWrong && (
        <span id={wrongId} role="alert" className={classes.wrong}>
          {props.wrong}
        </span>
      )}
    </span>
  );
}
