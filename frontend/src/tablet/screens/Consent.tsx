/**
 * Consent with statements to tick and a signature: nothing is sent before the participant presses.
 */
import { Button, Checkbox, TextInput } from "@mantine/core";
import { type ConsentForm, consents } from "@shared/api/records";
import type { TabletState } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useStoredSigning } from "../drafts/useStored";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { STATE_KEY } from "../useTabletState";
import classes from "./Consent.module.css";
import { consentToSend, missingOf, type Signing } from "./consentToSend";
import { Prose, ScrollHint } from "./Prose";
import { QuestionButtons, QuestionNotice, useQuestion } from "./Question";
import { SignaturePad } from "./SignaturePad";
import screen from "./screens.module.css";

interface ConsentProps {
  readonly state: TabletState;
  readonly form: ConsentForm;
  readonly onRefuse: () => void;
}

export function Consent({ state, form, onRefuse }: ConsentProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [signing, setSigning] = useStoredSigning(state);
  const question = useQuestion(state);
  const [shown, setShown] = useState(false);
  const give = useMutation({
    mutationFn: () => consents.give(consentToSend(form, signing, state.step_index ?? 0)),
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  const missing = missingOf(form, signing);
  return (
    <form
      className={screen.reading}
      onSubmit={(event) => {
        event.preventDefault();
        setShown(true);
        if (missing === null) give.mutate();
      }}
    >
      <h1 className={screen.readingTitle}>{state.title ?? t("consent.title")}</h1>
      <Prose text={state.text ?? ""} />
      <Statements form={form} signing={signing} onChange={setSigning} />
      <Sign form={form} signing={signing} onChange={setSigning} />
      <div className={screen.ask} aria-live="polite">
        <QuestionNotice question={question} />
        {shown && missing !== null && (
          <Notice tone="warn" title={t(`consent.missing.${missing}`)} />
        )}
        {give.isError && <Failure error={give.error} onRetry={() => give.mutate()} />}
      </div>
      <ScrollHint />
      <div className={screen.foot}>
        <QuestionButtons question={question} onRefuse={onRefuse} />
        <Button
          type="submit"
          size="lg"
          loading={give.isPending}
          rightSection={<Icon name="check" />}
        >
          {t("consent.go")}
        </Button>
      </div>
    </form>
  );
}

interface PartProps {
  readonly form: ConsentForm;
  readonly signing: Signing;
  readonly onChange: (signing: Signing) => void;
}

function Statements({ form, signing, onChange }: PartProps): JSX.Element | null {
  const { t } = useTexts();
  if (form.statements.length === 0) return null;
  return (
    <fieldset className={classes.statements}>
      <legend>{t("consent.statements")}</legend>
      {form.statements.map((one, at) => (
        <Checkbox
          // biome-ignore lint/suspicious/noArrayIndexKey: statements are identified by their position
          key={at}
          size="md"
          label={one.text}
          description={one.optional ? t("form.optional") : undefined}
          checked={signing.ticked.includes(at)}
          onChange={(event) =>
            onChange({
              ...signing,
              ticked: event.currentTarget.checked
                ? [...signing.ticked, at]
                : signing.ticked.filter((other) => other !== at),
            })
          }
        />
      ))}
    </fieldset>
  );
}

function Sign({ form, signing, onChange }: PartProps): JSX.Element | null {
  const { t } = useTexts();
  if (form.signature === "none") return null;
  const types = form.signature === "typed" || signing.types;
  return (
    <section className={classes.sign}>
      <h2>{t("consent.signature")}</h2>
      {types ? (
        <TextInput
          label={t("consent.name")}
          size="md"
          maxLength={120}
          autoComplete="off"
          spellCheck={false}
          value={signing.name}
          onChange={(event) => onChange({ ...signing, name: event.currentTarget.value })}
        />
      ) : (
        <SignaturePad path={signing.path} onChange={(path) => onChange({ ...signing, path })} />
      )}
      {form.signature === "drawn" && (
        <Button
          variant="subtle"
          color="gray"
          size="sm"
          onClick={() => onChange({ ...signing, types: !signing.types })}
        >
          {t(types ? "consent.draw" : "consent.type")}
        </Button>
      )}
    </section>
  );
}
