/** Which column contains which item; a wide file has one set of columns per condition. */
import { Button, Checkbox, Select, TextInput, Title } from "@mantine/core";
import type { ImportMapping, ImportPreview } from "@shared/api/imports";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Imports.module.css";

interface ItemsProps {
  readonly preview: ImportPreview;
  readonly items: readonly {
    readonly key: string;
    readonly text: Readonly<Record<string, string>>;
  }[];
  /** Items that the formulas reverse. */
  readonly reversed: readonly string[];
  readonly mapping: ImportMapping;
  readonly onChange: (part: Partial<ImportMapping>) => void;
}

export function ItemColumns({
  preview,
  items,
  reversed,
  mapping,
  onChange,
}: ItemsProps): JSX.Element {
  const { t, language } = useTexts();
  const { sets } = mapping;
  const columns = preview.columns.map(({ name }) => name);
  const put = (at: number, item: string, column: string | null): void =>
    onChange({
      sets: sets.map((one, place) =>
        place === at ? { ...one, items: within(one.items, item, column) } : one,
      ),
    });
  const name = (at: number, condition: string): void =>
    onChange({ sets: sets.map((one, place) => (place === at ? { ...one, condition } : one)) });
  return (
    <section aria-label={t("imports.items")}>
      <div className={classes.head}>
        <Title order={3} size="h5">
          {t("imports.items")}
        </Title>
        {mapping.condition === null && (
          <Button
            size="compact-sm"
            variant="subtle"
            leftSection={<Icon name="add" size={15} />}
            onClick={() => onChange({ sets: [...sets, { items: {}, condition: "" }] })}
          >
            {t("imports.addSet")}
          </Button>
        )}
      </div>
      <div className={classes.scroll}>
        <table className={classes.items}>
          <thead>
            <tr>
              <th scope="col">{t("imports.item")}</th>
              {sets.map((one, at) => (
                // biome-ignore lint/suspicious/noArrayIndexKey: sets are identified by their position
                <th key={at} scope="col">
                  {sets.length > 1 ? (
                    <div className={classes.set}>
                      <TextInput
                        size="xs"
                        aria-label={t("imports.setCondition", { n: at + 1 })}
                        placeholder={t("imports.condition")}
                        maxLength={80}
                        value={one.condition ?? ""}
                        onChange={(event) => name(at, event.currentTarget.value)}
                      />
                      <Button
                        size="compact-xs"
                        variant="subtle"
                        color="gray"
                        onClick={() => onChange({ sets: kept(sets, at) })}
                      >
                        {t("imports.removeSet")}
                      </Button>
                    </div>
                  ) : (
                    t("imports.column")
                  )}
                </th>
              ))}
              {reversed.length > 0 && <th scope="col">{t("imports.turned")}</th>}
            </tr>
          </thead>
          <tbody>
            {items.map(({ key, text }) => (
              <tr key={key}>
                <th scope="row">
                  <code>{key}</code>{" "}
                  <span className={classes.soft}>{inLanguage(text, language)}</span>
                </th>
                {sets.map((one, at) => (
                  // biome-ignore lint/suspicious/noArrayIndexKey: sets are identified by their position
                  <td key={at}>
                    <Select
                      size="xs"
                      aria-label={t("imports.columnOf", { item: key, n: at + 1 })}
                      placeholder={t("imports.noColumn")}
                      searchable
                      clearable
                      data={columns}
                      value={one.items[key] ?? null}
                      onChange={(value) => put(at, key, value)}
                    />
                  </td>
                ))}
                {reversed.length > 0 && (
                  <td>
                    {reversed.includes(key) && (
                      <Checkbox
                        size="xs"
                        label={t("imports.turned.file")}
                        checked={mapping.turned.includes(key)}
                        onChange={(event) =>
                          onChange({
                            turned: event.currentTarget.checked
                              ? [...mapping.turned, key]
                              : mapping.turned.filter((one) => one !== key),
                          })
                        }
                      />
                    )}
                  </td>
                )}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {reversed.length > 0 && <p className={classes.soft}>{t("imports.turned.about")}</p>}
    </section>
  );
}

function within(
  items: Readonly<Record<string, string>>,
  item: string,
  column: string | null,
): Record<string, string> {
  const others = Object.fromEntries(Object.entries(items).filter(([key]) => key !== item));
  return column === null ? others : { ...others, [item]: column };
}

function kept(sets: ImportMapping["sets"], at: number): ImportMapping["sets"] {
  const left = sets.filter((_, place) => place !== at);
  return left.length === 1
    ? left.map((one) => ({ ...one, condition: one.condition || null }))
    : left;
}
