/** The deletion of a body that has no name, so that no study or record can refer to it. */
import { Button } from "@mantine/core";
import { type BodyView, bodies } from "@shared/api/bodies";
import { useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";
import { DeleteDialog } from "../ui/DeleteDialog";
import { titleOf } from "./names";
import { bodiesQuery, bodyQuery } from "./queries";

export function DeleteBody({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [, navigate] = useLocation();
  const [isOpen, setOpen] = useState(false);
  const hash = body.content_hash;
  return (
    <>
      <Button variant="subtle" color="red" size="xs" onClick={() => setOpen(true)}>
        {t("captures.delete.short")}
      </Button>
      <DeleteDialog
        isOpen={isOpen}
        title={t("bodies.delete.title")}
        words={t("bodies.delete.words", { name: titleOf(body) })}
        onDelete={() => bodies.remove(hash)}
        onClose={() => setOpen(false)}
        onDeleted={() => {
          navigate("/bodies");
          queries.removeQueries({ queryKey: bodyQuery(hash).queryKey });
          return queries.invalidateQueries({ queryKey: bodiesQuery.queryKey, exact: true });
        }}
      />
    </>
  );
}
