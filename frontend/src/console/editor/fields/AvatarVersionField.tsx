/** The avatar that a study uses: one of the saved versions, by name, with the way to it. */
import { Anchor, Select } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useRef } from "react";
import { Link } from "wouter";
import { savedAvatarsQuery } from "../../avatarEditor/tryout/source";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { useForm, useProblem, useValue } from "../formContext";
import { isObject, type Path } from "../paths";

/** What the history's state says after a version was chosen elsewhere: the field shows itself. */
const SHOWN = "avatar";

interface AvatarVersionFieldProps {
  readonly path: Path;
}

export function AvatarVersionField({ path }: AvatarVersionFieldProps): JSX.Element {
  const { t } = useTexts();
  const { change, reveal } = useForm();
  const value = useValue(path);
  const { data: avatars = [] } = useQuery(savedAvatarsQuery);
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!isObject(history.state) || history.state.shown !== SHOWN) return;
    // Once only, not again when the page is loaded again.
    history.replaceState(null, "");
    place.current?.focus();
    reveal(path);
  }, [path, reveal]);
  const problems = [
    useProblem(path),
    useProblem([...path, "key"]),
    useProblem([...path, "version"]),
  ].filter((problem) => problem !== null);
  const key = isObject(value) ? String(value.key ?? "") : "";
  const version = isObject(value) ? Number(value.version ?? 1) : 1;
  const named = `${key} ${version}`;
  const saved = avatars.flatMap((one) =>
    Array.from({ length: one.newest.number }, (_, back) => {
      const number = one.newest.number - back;
      const label = t("tryout.compare.version", { title: one.title, number });
      const hash = one.content_hashes[number - 1]?.slice(0, 12) ?? "";
      return { value: `${one.key} ${number}`, label, hash };
    }),
  );
  const chosen = saved.find((one) => one.value === named);
  const hashes = new Map(saved.map((one) => [one.value, one.hash]));
  return (
    <div ref={place} tabIndex={-1}>
      <Select
        label={t("editor.avatarVersion")}
        description={
          chosen === undefined ? undefined : t("editor.avatarVersion.hash", { hash: chosen.hash })
        }
        data={
          chosen !== undefined || key === "" ? saved : [{ value: named, label: named }, ...saved]
        }
        renderOption={({ option }) => (
          <span className={classes.avatarOption}>
            {option.label}
            <code>{hashes.get(option.value)}</code>
          </span>
        )}
        value={key === "" ? null : named}
        searchable
        allowDeselect={false}
        error={problems.length > 0 ? problems.join(" ") : undefined}
        onFocus={() => reveal(path)}
        onChange={(next) => {
          const [nextKey = "", number = ""] = (next ?? "").split(" ");
          if (nextKey === "") return;
          change([{ path, action: "set", value: { key: nextKey, version: Number(number) } }]);
        }}
      />
      {chosen !== undefined && (
        <Anchor component={Link} href={`/avatars/${key}/${version}`} size="sm">
          {t("editor.avatarVersion.open")}
        </Anchor>
      )}
    </div>
  );
}
