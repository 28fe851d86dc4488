/** Correct one answer: a later value and its reason. */
import { Button, Group, Textarea } from "@mantine/core";
import { type AnswerValue, type Form, rights } from "@shared/api/rights";
import type { Item } from "@shared/api/types";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useFormSubmit } from "../ui/useSingleSubmit";
import { AnswerField } from "./AnswerField";
import classes from "./Rights.module.css";

interface CorrectAnswerProps {
  readonly sessionId: string;
  readonly form: Form;
  readonly item: Item;
  readonly onDone: () => void;
}

export function CorrectAnswer({ sessionId, form, item, onDone }: CorrectAnswerProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const before = form.answers[item.key] ?? null;
  const [value, setValue] = useState<AnswerValue>(before);
  const [reason, setReason] = useState("");
  const correct = useMutation({
    mutationFn: () =>
      rights.correct(sessionId, form.submission_id, {
        item: item.key,
        value,
        reason: reason.trim(),
      }),
    onSuccess: () => {
      void queries.invalidateQueries({ queryKey: ["sessions", sessionId] });
      onDone();
    },
  });
  const submit = useFormSubmit(correct);
  const same = Number(value) === before || value === before;
  return (
    <form className={classes.correct} onSubmit={submit}>
      <AnswerField form={form} item={item} value={value} onChange={setValue} />
      <Textarea
        label={t("answers.why")}
        description={t("answers.why.hint")}
        autosize
        minRows={2}
        maxLength={2000}
        value={reason}
        onChange={(event) => setReason(event.currentTarget.value)}
      />
      {correct.isError && <Failure error={correct.error} />}
      <Group justify="flex-end">
        <Button variant="default" size="xs" onClick={onDone}>
          {t("action.cancel")}
        </Button>
        <Button
          type="submit"
          size="xs"
          disabled={(value !== null && same) || value === before || reason.trim() === ""}
          loading={correct.isPending}
        >
          {t("answers.save")}
        </Button>
      </Group>
    </form>
  );
}
