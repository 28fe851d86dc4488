/** Takes settings from a version of another avatar, which serves as a preset: all, or a group's. */
import { Button, Select } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import type { Operation } from "./api";
import { type AvatarFile, GROUPS } from "./axes";
import { Differences } from "./Differences";
import classes from "./Editor.module.css";
import { ASPECTS, type Aspects, takeFrom } from "./operations";
import { savedVersionQuery } from "./tryout/source";
import { useOthers } from "./tryout/useBodies";

const EVERYTHING = "everything";

interface TakeFromProps {
  readonly avatarKey: string;
  readonly configuration: AvatarFile;
  /** What the version is compared with. */
  readonly work: string;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
  readonly isReadOnly: boolean;
}

export function TakeFrom(props: TakeFromProps): JSX.Element | null {
  const { avatarKey, configuration, work, edit, isReadOnly } = props;
  const texts = useTexts();
  const { t } = texts;
  const others = useOthers().filter(({ value }) => !value.startsWith(`${avatarKey} `));
  const [wished, setSource] = useState<string | null>(null);
  const [scope, setScope] = useState<string>(EVERYTHING);
  const [aspects, setAspects] = useState<Aspects>("gains");
  const [isCompared, setCompared] = useState(false);
  const source = others.find(({ value }) => value === wished) ?? null;
  if (others.length === 0) return null;
  const title = t("avatars.take");
  return (
    <section className={classes.panel} aria-label={title}>
      <h3 className={classes.sub}>{title}</h3>
      <p className={classes.soft}>{t("avatars.take.hint")}</p>
      <form
        className={classes.row}
        aria-label={title}
        onSubmit={(event) => {
          event.preventDefault();
          if (source === null || isReadOnly) return;
          const groups = scope === EVERYTHING ? null : [scope];
          void edit(
            takeFrom(source.value, groups, aspects),
            t("avatars.did.take", {
              name: scope === EVERYTHING ? t("avatars.take.everything") : groupName(texts, scope),
              version: source.label,
            }),
          );
        }}
      >
        <Select
          size="xs"
          w={260}
          label={t("avatars.take.from")}
          placeholder={t("avatars.take.choose")}
          searchable
          allowDeselect={false}
          value={source?.value ?? null}
          onChange={setSource}
          data={others}
        />
        {!isReadOnly && (
          <Select
            size="xs"
            label={t("avatars.take.what")}
            allowDeselect={false}
            value={scope}
            onChange={(one) => one !== null && setScope(one)}
            data={[
              { value: EVERYTHING, label: t("avatars.take.everything") },
              ...GROUPS.map((group) => ({ value: group, label: groupName(texts, group) })),
            ]}
          />
        )}
        {!isReadOnly && scope !== EVERYTHING && (
          <Select
            size="xs"
            label={t("avatars.take.values")}
            allowDeselect={false}
            value={aspects}
            onChange={(one) => one !== null && setAspects(one as Aspects)}
            data={Object.keys(ASPECTS).map((one) => ({
              value: one,
              label: t(`avatars.take.${one as Aspects}`),
            }))}
          />
        )}
        {!isReadOnly && (
          <Button type="submit" size="xs" variant="default" disabled={source === null}>
            {t("avatars.take.do")}
          </Button>
        )}
        <Button
          size="xs"
          variant="default"
          disabled={source === null}
          aria-expanded={source !== null && isCompared}
          onClick={() => setCompared(!isCompared)}
        >
          {t("avatars.compare")}
        </Button>
      </form>
      {source !== null && isCompared && (
        <Compared
          source={source.value}
          column={source.label}
          configuration={configuration}
          work={work}
        />
      )}
    </section>
  );
}

interface ComparedProps {
  /** The version, as `key number`. */
  readonly source: string;
  readonly column: string;
  readonly configuration: AvatarFile;
  readonly work: string;
}

function Compared({ source, column, configuration, work }: ComparedProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Loaded query={useQuery(savedVersionQuery(source))}>
      {(version) => (
        <Differences
          label={t("avatars.compare")}
          before={version.configuration}
          after={configuration}
          columns={[column, work]}
        />
      )}
    </Loaded>
  );
}
