/** The field for any value in the file, chosen by its schema. */
import { ActionIcon, Autocomplete, Button, Menu, TagsInput } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { type FormEvent, type JSX, type KeyboardEvent, useRef, useState } from "react";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { firstPreregistration } from "../firstPreregistration";
import { useForm, useLabels, useProblem, useValue } from "../formContext";
import { isList, isObject, type Json, type Path } from "../paths";
import { blank, type Field, type ListSpec, type ObjectSpec, type Spec } from "../schema";
import { AvatarVersionField } from "./AvatarVersionField";
import { BooleanField, ChoiceField, NumberField, useNewKey, WordsField } from "./Simple";
import { TextsField } from "./Texts";

interface SpecFieldProps {
  readonly path: Path;
  readonly spec: Spec;
  readonly label: string;
}

function SpecField({ path, spec, label }: SpecFieldProps): JSX.Element | null {
  switch (spec.kind) {
    case "texts":
      return <TextsField path={path} label={label} />;
    case "choice":
      return <ChoiceField path={path} label={label} values={spec.values} />;
    case "number":
      return <NumberField path={path} label={label} spec={spec} />;
    case "boolean":
      return <BooleanField path={path} label={label} />;
    case "words":
      return <WordsField path={path} label={label} pattern={spec.pattern} />;
    case "tuple":
      return <TupleField path={path} spec={spec.items} label={label} />;
    case "list":
      return isWords(spec.item) ? (
        <TagsField path={path} spec={spec} label={label} />
      ) : (
        <ListField path={path} spec={spec} label={label} />
      );
    case "object":
      return (
        <fieldset className={classes.group}>
          <legend>{label}</legend>
          {path.join(".") === "avatar_configuration" ? (
            <AvatarVersionField path={path} />
          ) : (
            <ObjectFields path={path} spec={spec} />
          )}
        </fieldset>
      );
    case "union":
      return <UnionFields path={path} spec={spec} />;
    case "map":
      // Maps of texts have a page of their own.
      return spec.value.kind === "texts" ? null : (
        <MapField path={path} spec={spec.value} label={label} />
      );
    default:
      return null; // a fixed value leaves nothing to choose
  }
}

const isWords = (spec: Spec): boolean => spec.kind === "words" || spec.kind === "choice";

interface ObjectFieldsProps {
  readonly path: Path;
  readonly spec: ObjectSpec;
  /** Fields that are shown elsewhere. */
  readonly without?: readonly string[];
}

/** The fields that are present or required, and buttons that add the others. */
export function ObjectFields({ path, spec, without = [] }: ObjectFieldsProps): JSX.Element {
  const { t } = useTexts();
  const { change, languages, tree, known } = useForm();
  const labels = useLabels();
  const value = useValue(path);
  const begun = (field: Field): Json =>
    path.length === 0 && field.name === "preregistration"
      ? firstPreregistration(tree, known)
      : blank(field.spec, languages);
  const has = (field: Field) => isObject(value) && value[field.name] !== undefined;
  const fields = spec.fields.filter(
    (field) => !without.includes(field.name) && field.spec.kind !== "fixed",
  );
  // A word has no blank that would be valid: its field is opened, and nothing written before it has
  // one.
  const [opened, setOpened] = useState<ReadonlySet<string>>(NONE_OPENED);
  const place = useRef<HTMLDivElement>(null);
  const isOpen = (field: Field) => opened.has(field.name) && !has(field);
  const close = (name: string) =>
    setOpened((before) => new Set([...before].filter((one) => one !== name)));
  const open = (name: string) => {
    setOpened((before) => new Set([...before, name]));
    requestAnimationFrame(() =>
      place.current
        ?.querySelector<HTMLElement>(`[data-opened="${name}"] :is(input, textarea)`)
        ?.focus(),
    );
  };
  const absent = fields.filter((field) => !field.required && !has(field) && !isOpen(field));
  return (
    <div className={classes.fields} ref={place}>
      {fields
        .filter((field) => field.required || has(field) || isOpen(field))
        .map((field) => (
          <div
            key={field.name}
            className={isWide(field.spec) ? classes.wide : classes.narrow}
            data-opened={isOpen(field) ? field.name : undefined}
          >
            <SpecField
              path={[...path, field.name]}
              spec={field.spec}
              label={labels.field(field.name, path)}
            />
            {!field.required && (
              <button
                type="button"
                className={classes.drop}
                onClick={() => {
                  close(field.name);
                  if (has(field)) change([{ path: [...path, field.name], action: "remove" }]);
                }}
              >
                {t("editor.leaveOut", { name: labels.field(field.name, path) })}
              </button>
            )}
          </div>
        ))}
      {absent.length > 0 && (
        <div className={classes.wide}>
          {absent.map((field) => (
            <Button
              key={field.name}
              size="compact-xs"
              variant="subtle"
              leftSection={<Icon name="add" size={14} />}
              onClick={() => {
                if (field.spec.kind === "words") return open(field.name);
                change([{ path: [...path, field.name], action: "set", value: begun(field) }]);
              }}
            >
              {labels.field(field.name, path)}
            </Button>
          ))}
        </div>
      )}
    </div>
  );
}

const NONE_OPENED: ReadonlySet<string> = new Set();

const isWide = (spec: Spec): boolean =>
  spec.kind === "texts" ||
  spec.kind === "object" ||
  spec.kind === "map" ||
  isProse(spec) ||
  (spec.kind === "list" && (!isWords(spec.item) || isProse(spec.item)));

/** Keys have a pattern and are short; a text without a pattern is prose. */
const isProse = (spec: Spec): boolean => spec.kind === "words" && spec.pattern === null;

function UnionFields({
  path,
  spec,
}: {
  readonly path: Path;
  readonly spec: Extract<Spec, { kind: "union" }>;
}): JSX.Element | null {
  const value = useValue(path);
  const tag = isObject(value) ? value[spec.tag] : undefined;
  const option = typeof tag === "string" ? spec.options[tag] : undefined;
  return option === undefined ? null : <ObjectFields path={path} spec={option} />;
}

interface MapFieldProps {
  readonly path: Path;
  /** What each value is. */
  readonly spec: Spec;
  readonly label: string;
}

/** Values by a key that the writer chooses: items by their instrument, an aspect by its item. */
function MapField({ path, spec, label }: MapFieldProps): JSX.Element {
  const { t } = useTexts();
  const { change, languages } = useForm();
  const value = useValue(path);
  const problem = useProblem(path);
  const added = useNewKey(path, label);
  const [key, setKey] = useState("");
  const keys = isObject(value) ? Object.keys(value) : [];
  const add = (event: FormEvent) => {
    event.preventDefault();
    const name = key.trim();
    if (name === "" || keys.includes(name)) return;
    change([{ path: [...path, name], action: "set", value: blank(spec, languages) }]);
    setKey("");
  };
  return (
    <fieldset className={`${classes.group} ${classes.map}`}>
      <legend>{label}</legend>
      {problem !== null && <p className={classes.problem}>{problem}</p>}
      {keys.map((name) => (
        <div key={name}>
          <SpecField path={[...path, name]} spec={spec} label={name} />
          <button
            type="button"
            className={classes.drop}
            onClick={() => change([{ path: [...path, name], action: "remove" }])}
          >
            {t("editor.leaveOut", { name })}
          </button>
        </div>
      ))}
      <form className={classes.inline} onSubmit={add}>
        <Autocomplete
          label={added.label}
          data={added.known.filter((one) => !keys.includes(one))}
          value={key}
          onChange={setKey}
        />
        <Button type="submit" variant="default" leftSection={<Icon name="add" size={16} />}>
          {t("editor.add")}
        </Button>
      </form>
    </fieldset>
  );
}

interface TupleFieldProps {
  readonly path: Path;
  readonly spec: readonly Spec[];
  readonly label: string;
}

const AXES = ["x", "y", "z"] as const;

function TupleField({ path, spec, label }: TupleFieldProps): JSX.Element {
  const problem = useProblem(path);
  return (
    <fieldset className={classes.tuple}>
      <legend>{label}</legend>
      <div className={classes.axes}>
        {spec.map((item, index) => (
          <SpecField
            // biome-ignore lint/suspicious/noArrayIndexKey: a coordinate is identified by its position
            key={index}
            path={[...path, index]}
            spec={item}
            label={AXES[index] ?? String(index + 1)}
          />
        ))}
      </div>
      {problem !== null && <p className={classes.problem}>{problem}</p>}
    </fieldset>
  );
}

interface TagsFieldProps {
  readonly path: Path;
  readonly spec: ListSpec;
  readonly label: string;
}

/** A list of words: languages, sides, body parts. */
function TagsField({ path, spec, label }: TagsFieldProps): JSX.Element {
  const { change, reveal } = useForm();
  const { hint } = useLabels();
  const value = useValue(path);
  const problem = useProblem(path);
  const words = isList(value) ? value.map(String) : [];
  return (
    <TagsInput
      label={label}
      description={hint(String(path.at(-1)))}
      error={problem}
      classNames={isProse(spec.item) ? { pill: classes.prose ?? "" } : {}}
      data={spec.item.kind === "choice" ? [...spec.item.values] : []}
      value={words}
      acceptValueOnBlur
      onChange={(next) => change([{ path, action: "set", value: next }])}
      onFocus={() => reveal(path)}
    />
  );
}

interface ListFieldProps {
  readonly path: Path;
  readonly spec: ListSpec;
  readonly label: string;
}

/** A list whose entries are edited one by one: conditions, steps, phases, boxes, orders. */
export function ListField({ path, spec, label }: ListFieldProps): JSX.Element {
  const value = useValue(path);
  const problem = useProblem(path);
  const items = isList(value) ? value : [];
  return (
    <fieldset className={classes.list}>
      <legend>{label}</legend>
      {problem !== null && <p className={classes.problem}>{problem}</p>}
      <ol>
        {items.map((item, index) => (
          <Entry
            // biome-ignore lint/suspicious/noArrayIndexKey: an entry is identified by its position in the file
            key={index}
            path={[...path, index]}
            spec={spec}
            item={item}
            count={items.length}
          />
        ))}
      </ol>
      <Add path={path} spec={spec} count={items.length} last={items.at(-1)} />
    </fieldset>
  );
}

interface EntryProps {
  readonly path: Path;
  readonly spec: ListSpec;
  readonly item: Json;
  readonly count: number;
}

function Entry({ path, spec, item, count }: EntryProps): JSX.Element {
  const { t } = useTexts();
  const { change } = useForm();
  const problem = useProblem(path);
  const name = useName(item);
  const index = Number(path.at(-1));
  const move = (to: number) => {
    if (to >= 0 && to < count) change([{ path, action: "move", to }]);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const step = event.altKey ? { ArrowUp: -1, ArrowDown: 1 }[event.key] : undefined;
    if (step === undefined) return;
    event.preventDefault();
    move(index + step);
  };
  const label = name === String(index + 1) ? name : `${index + 1}. ${name}`;
  return (
    <li className={classes.entry}>
      {/* biome-ignore lint/a11y/noStaticElementInteractions: the keys belong to the buttons in it */}
      <div className={classes.entryHead} onKeyDown={onKeyDown}>
        <span className={classes.entryName}>{label}</span>
        <Tool
          icon="up"
          label={t("editor.up", { name: label })}
          off={index === 0}
          onClick={() => move(index - 1)}
        />
        <Tool
          icon="down"
          label={t("editor.down", { name: label })}
          off={index === count - 1}
          onClick={() => move(index + 1)}
        />
        <Tool
          icon="close"
          label={t("editor.remove", { name: label })}
          off={count <= spec.atLeast}
          onClick={() => change([{ path, action: "remove" }])}
        />
      </div>
      {problem !== null && <p className={classes.problem}>{problem}</p>}
      {spec.item.kind === "object" ? (
        <ObjectFields path={path} spec={spec.item} />
      ) : (
        <SpecField path={path} spec={spec.item} label={t("editor.entry", { number: index + 1 })} />
      )}
    </li>
  );
}

interface ToolProps {
  readonly icon: "up" | "down" | "close";
  readonly label: string;
  readonly off: boolean;
  readonly onClick: () => void;
}

function Tool({ icon, label, off, onClick }: ToolProps): JSX.Element {
  return (
    <ActionIcon
      variant="subtle"
      color="gray"
      size="md"
      aria-label={label}
      disabled={off}
      onClick={onClick}
    >
      <span className={icon === "up" ? classes.rotated : undefined}>
        <Icon name={icon === "up" ? "down" : icon} size={16} />
      </span>
    </ActionIcon>
  );
}

/** The name of an entry: its step, its limb, its key or its number. */
function useName(item: Json): string {
  const labels = useLabels();
  if (!isObject(item)) return isList(item) ? item.map(String).join(" → ") : String(item);
  const word = item.step ?? item.limb;
  const identifier = item.instrument ?? item.key ?? item.number;
  const label = typeof word === "string" ? labels.value(word) : "";
  return [label, identifier === undefined ? "" : String(identifier)]
    .filter((part) => part !== "")
    .join(" · ");
}

interface AddProps {
  readonly path: Path;
  readonly spec: ListSpec;
  readonly count: number;
  readonly last: Json | undefined;
}

function Add({ path, spec, count, last }: AddProps): JSX.Element {
  const { t } = useTexts();
  const { change, languages } = useForm();
  const labels = useLabels();
  const add = (value: Json) => change([{ path: [...path, count], action: "insert", value }]);
  const icon = <Icon name="add" size={16} />;
  if (spec.item.kind === "union") {
    const { item } = spec;
    return (
      <Menu withInitialFocusPlaceholder={false}>
        <Menu.Target>
          <Button size="xs" variant="default" leftSection={icon}>
            {t("editor.addStep")}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          {Object.keys(item.options).map((tag) => (
            <Menu.Item key={tag} onClick={() => add(blank(item, languages, tag))}>
              {labels.value(tag)}
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    );
  }
  // A copy of the last entry is a better start than empty fields.
  const next = isList(last) ? last : blank(spec.item, languages);
  return (
    <Button size="xs" variant="default" leftSection={icon} onClick={() => add(next)}>
      {t("editor.add")}
    </Button>
  );
}
