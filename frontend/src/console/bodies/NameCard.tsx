/** The name of a body, which is given once, its title, and the terms that must be confirmed. */
import { Button, Checkbox, TextInput, Title } from "@mantine/core";
import { type BodyView, bodies, type LicenceTerm } from "@shared/api/bodies";
import { dateTime } from "@shared/format";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { nameOf } from "../account";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Bodies.module.css";
import { bodiesQuery, bodyQuery } from "./queries";

const NAME = /^[a-z][a-z0-9_-]{0,79}$/;

interface NameCardProps {
  readonly body: BodyView;
  readonly canWrite: boolean;
}

export function NameCard({ body, canWrite }: NameCardProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <section className={classes.panel} aria-labelledby="body-name">
      <Title order={2} size="h3" id="body-name">
        {t("bodies.name")}
      </Title>
      {body.name === null ? (
        <p className={classes.soft}>{t(canWrite ? "bodies.name.none" : "bodies.name.reader")}</p>
      ) : (
        <p className={classes.soft}>
          <code className={classes.key}>{body.name}</code> {t("bodies.name.given")}
        </p>
      )}
      {body.confirmations.map(({ term, by, at }) => (
        <p key={term} className={classes.soft}>
          {t(`bodies.term.${term}.confirmed`, { by: nameOf(by), at: dateTime(at, language) })}
        </p>
      ))}
      {canWrite && <NameForm body={body} />}
    </section>
  );
}

/** A name that could be that of the file. */
const proposed = (file: string): string =>
  file
    .replace(/\.[^.]+$/, "")
    .toLowerCase()
    .replace(/[^a-z0-9_-]+/g, "-")
    .replace(/^[^a-z]+|-+$/g, "")
    .slice(0, 80);

function NameForm({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [name, setName] = useState(proposed(body.file_name));
  const [title, setTitle] = useState(body.title ?? "");
  const [confirmed, setConfirmed] = useState<readonly LicenceTerm[]>([]);
  const isNamed = body.name !== null;
  const change = useMutation({
    mutationFn: () =>
      bodies.change(body.content_hash, {
        ...(isNamed ? {} : { name }),
        ...(title.trim() === "" ? {} : { title: title.trim() }),
        confirmed: [...confirmed],
      }),
    onSuccess: (changed) => {
      queries.setQueryData(bodyQuery(body.content_hash).queryKey, changed);
      void queries.invalidateQueries({ queryKey: bodiesQuery.queryKey, exact: true });
    },
  });
  const isMissing = body.asked.some((term) => !confirmed.includes(term));
  const isSame = isNamed && title.trim() === (body.title ?? "");
  const isWrong = !isNamed && !NAME.test(name);
  return (
    <form
      className={classes.form}
      onSubmit={(event) => {
        event.preventDefault();
        if (!isWrong && !isMissing && !isSame) change.mutate();
      }}
    >
      {!isNamed && (
        <TextInput
          label={t("bodies.name.field")}
          description={t("bodies.name.hint")}
          value={name}
          maxLength={80}
          error={name !== "" && isWrong ? t("bodies.name.wrong") : null}
          onChange={(event) => setName(event.currentTarget.value)}
        />
      )}
      <TextInput
        label={t("bodies.title.field")}
        description={t("bodies.title.hint")}
        value={title}
        maxLength={200}
        onChange={(event) => setTitle(event.currentTarget.value)}
      />
      {body.asked.map((term) => (
        <Checkbox
          key={term}
          label={t(`bodies.term.${term}`)}
          description={t("bodies.term.hint")}
          checked={confirmed.includes(term)}
          onChange={(event) =>
            setConfirmed((all) =>
              event.currentTarget.checked ? [...all, term] : all.filter((one) => one !== term),
            )
          }
        />
      ))}
      <div>
        <Button
          type="submit"
          size="xs"
          loading={change.isPending}
          disabled={isWrong || isMissing || isSame}
        >
          {t(isNamed ? "bodies.title.save" : "bodies.name.save")}
        </Button>
      </div>
      {change.isError && <Failure error={change.error} />}
    </form>
  );
}
