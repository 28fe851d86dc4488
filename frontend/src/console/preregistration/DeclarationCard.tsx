/** The preregistration, with the version and the hash that identify it. */
import { Paper, Title } from "@mantine/core";
import type { Declaration } from "@shared/api/analysis";
import { dateTime } from "@shared/format";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Preregistration.module.css";
import { primaryWords } from "./primaryWords";

export function DeclarationCard({
  declaration,
}: {
  readonly declaration: Declaration;
}): JSX.Element {
  const { t, language } = useTexts();
  const frozen = declaration.frozen_at;
  const rules = declaration.section.exclusions ?? [];
  return (
    <Paper>
      <Title order={2} size="h3">
        {t("prereg.declared")}
      </Title>
      <dl className={classes.facts}>
        <dt>{t("prereg.primary")}</dt>
        <dd>
          <Primary declaration={declaration} />
        </dd>
        <dt>α</dt>
        <dd>{declaration.alpha}</dd>
        <dt>{t("prereg.planned")}</dt>
        <dd>{declaration.planned_n}</dd>
        <dt>{t("prereg.rules")}</dt>
        <dd>
          {rules.length === 0 ? (
            t("prereg.rules.none")
          ) : (
            <ul className={classes.plain}>
              {rules.map(({ rule, limit }) => (
                <li key={rule}>{t(`prereg.rule.${rule}`, { limit: limit ?? "" })}</li>
              ))}
            </ul>
          )}
        </dd>
        <dt>{t("prereg.version")}</dt>
        <dd>
          {t("prereg.version.made", {
            version: declaration.version,
            when: dateTime(declaration.created_at, language),
          })}
        </dd>
        <dt>{t("prereg.frozen")}</dt>
        <dd>{frozen === null ? t("prereg.frozen.not") : dateTime(frozen, language)}</dd>
        <dt>{t("prereg.registration")}</dt>
        <dd>{declaration.registration || t("prereg.registration.none")}</dd>
        <dt>SHA-256</dt>
        <dd className={classes.hash}>{declaration.content_hash}</dd>
      </dl>
    </Paper>
  );
}

/** The preregistered test in words: test, measure, limb, direction. */
export function Primary({ declaration }: { readonly declaration: Declaration }): JSX.Element {
  const texts = useTexts();
  return <>{primaryWords(texts, declaration.section.primary, declaration.names)}</>;
}
