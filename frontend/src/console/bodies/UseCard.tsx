/** Who wears a body, and how a study wears it: the lines of its file, and a configuration. */
import { Anchor, Button, CopyButton, Select, TextInput, Title } from "@mantine/core";
import type { BodyUse, BodyView } from "@shared/api/bodies";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import classes from "./Bodies.module.css";
import { type AvatarSummary, avatarsQuery, bodyUseQuery, saveWearing } from "./queries";

interface UseCardProps {
  readonly body: BodyView;
  readonly canWrite: boolean;
}

const USUAL = "standard";

export function UseCard({ body, canWrite }: UseCardProps): JSX.Element {
  const { t } = useTexts();
  const use = useQuery(bodyUseQuery(body.content_hash));
  const avatars = useQuery(avatarsQuery);
  return (
    <section className={classes.panel} aria-labelledby="body-use">
      <Title order={2} size="h3" id="body-use">
        {t("bodies.use")}
      </Title>
      <Loaded query={use}>{(found) => <Wearers found={found} />}</Loaded>
      <h3 className={classes.sub}>{t("bodies.use.study")}</h3>
      {body.name === null ? (
        <p className={classes.soft}>{t("bodies.use.unnamed")}</p>
      ) : (
        <Lines name={body.name} avatars={avatars.data ?? []} />
      )}
      {canWrite && body.asked.length === 0 && (
        <Loaded query={avatars}>
          {(all) => all.length > 0 && <NewConfiguration body={body} avatars={all} />}
        </Loaded>
      )}
    </section>
  );
}

function Wearers({ found }: { readonly found: BodyUse }): JSX.Element {
  const { t } = useTexts();
  if (found.configurations.length + found.studies.length === 0) {
    return <p className={classes.soft}>{t("bodies.use.nobody")}</p>;
  }
  return (
    <dl className={classes.terms}>
      <div>
        <dt>{t("bodies.use.studies")}</dt>
        <dd>
          {found.studies.length === 0
            ? t("bodies.use.none")
            : found.studies.map(({ key, title }) => (
                <Anchor
                  key={key}
                  component={Link}
                  href={`/studies/${key}`}
                  className={classes.wearer ?? ""}
                  size="sm"
                >
                  {title}
                </Anchor>
              ))}
        </dd>
      </div>
      <div>
        <dt>{t("bodies.use.configurations")}</dt>
        <dd>
          {found.configurations.length === 0
            ? t("bodies.use.none")
            : found.configurations.map(({ key, version }) => (
                <span key={`${key} ${version}`} className={classes.wearer}>
                  {t("bodies.use.version", { key, version })}
                </span>
              ))}
        </dd>
      </div>
    </dl>
  );
}

interface LinesProps {
  readonly name: string;
  readonly avatars: readonly AvatarSummary[];
}

/** The lines of a study file that let a condition wear the body. */
function Lines({ name, avatars }: LinesProps): JSX.Element {
  const { t } = useTexts();
  const usual = avatars.find(({ key }) => key === USUAL) ?? avatars[0];
  const text = [
    "avatar: physics",
    `avatar_configuration: {key: ${usual?.key ?? USUAL}, version: ${usual?.newest.number ?? 1}}`,
    "conditions:",
    `  - key: as_${name.replaceAll("-", "_")}`.slice(0, 48),
    "    latency_ms: 0",
    `    body: ${name}`,
    `    label: {en: as ${name}, de: als ${name}}`,
  ].join("\n");
  return (
    <>
      <p className={classes.soft}>{t("bodies.use.lines")}</p>
      <div className={classes.lines}>
        <pre>{text}</pre>
        <CopyButton value={text}>
          {({ copied, copy }) => (
            <Button size="compact-xs" variant="default" onClick={copy}>
              {t(copied ? "action.copied" : "action.copy")}
            </Button>
          )}
        </CopyButton>
      </div>
    </>
  );
}

interface NewConfigurationProps {
  readonly body: BodyView;
  readonly avatars: readonly AvatarSummary[];
}

/** Save a configuration that wears the body, so that every condition of a study may wear it. */
function NewConfiguration({ body, avatars }: NewConfigurationProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const usual = avatars.find(({ key }) => key === USUAL) ?? avatars[0];
  const [base, setBase] = useState(usual?.key ?? USUAL);
  const [written, setKey] = useState<string | null>(null);
  const key = written ?? body.name ?? "";
  const save = useMutation({
    mutationFn: () => saveWearing(base, key, body.content_hash, avatars),
    onSuccess: () =>
      Promise.all([
        queries.invalidateQueries({ queryKey: avatarsQuery.queryKey }),
        queries.invalidateQueries({ queryKey: bodyUseQuery(body.content_hash).queryKey }),
      ]),
  });
  const isWrong = !/^[a-z][a-z0-9_-]{0,79}$/.test(key);
  return (
    <details className={classes.more}>
      <summary>{t("bodies.configure")}</summary>
      <form
        className={classes.form}
        onSubmit={(event) => {
          event.preventDefault();
          if (!isWrong) save.mutate();
        }}
      >
        <p className={classes.soft}>{t("bodies.configure.lead")}</p>
        <Select
          label={t("bodies.configure.base")}
          data={avatars.map((one) => ({ value: one.key, label: `${one.title} (${one.key})` }))}
          value={base}
          allowDeselect={false}
          onChange={(value) => value !== null && setBase(value)}
        />
        <TextInput
          label={t("bodies.configure.key")}
          description={t(
            avatars.some((one) => one.key === key)
              ? "bodies.configure.next"
              : "bodies.configure.new",
          )}
          value={key}
          maxLength={80}
          error={key !== "" && isWrong ? t("bodies.name.wrong") : null}
          onChange={(event) => setKey(event.currentTarget.value)}
        />
        <div className={classes.row}>
          <Button type="submit" size="xs" loading={save.isPending} disabled={isWrong}>
            {t("bodies.configure.save")}
          </Button>
          {save.data !== undefined && (
            <span role="status" className={classes.saved}>
              <Icon name="check" size={16} />
              {t("bodies.configure.saved", save.data)}
            </span>
          )}
        </div>
        {save.isError && <Failure error={save.error} />}
      </form>
    </details>
  );
}
