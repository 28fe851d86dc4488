/** A list of things that are edited one by one: conditions, steps, phases, boxes, orders. */
import { ActionIcon, Button, Menu } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import type { JSX, KeyboardEvent } from "react";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { useForm, useProblem, useValue } from "../formContext";
import { useLabels } from "../labels";
import { isList, isObject, type Json, type Path } from "../paths";
import { blank, type ListSpec } from "../schema";
import { ObjectFields, SpecField } from "./SpecField";

interface ListFieldProps {
  readonly path: Path;
  readonly spec: ListSpec;
  readonly label: string;
}

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
            // biome-ignore lint/suspicious/noArrayIndexKey: an entry is its place in the file
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
      <span className={icon === "up" ? classes.turned : undefined}>
        <Icon name={icon === "up" ? "down" : icon} size={16} />
      </span>
    </ActionIcon>
  );
}

/** What an entry is called: by its step, its limb, its key or its number. */
function useName(item: Json): string {
  const labels = useLabels();
  if (!isObject(item)) return isList(item) ? item.map(String).join(" → ") : String(item);
  const word = item.step ?? item.limb;
  const beside = item.instrument ?? item.key ?? item.number;
  const said = typeof word === "string" ? labels.value(word) : "";
  return [said, beside === undefined ? "" : String(beside)]
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
  // A copy of the last one is nearer to what is wanted than empty fields.
  const next = isList(last) ? last : blank(spec.item, languages);
  return (
    <Button size="xs" variant="default" leftSection={icon} onClick={() => add(next)}>
      {t("editor.add")}
    </Button>
  );
}
