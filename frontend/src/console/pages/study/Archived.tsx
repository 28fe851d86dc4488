/** Says that a study was put away, and takes it out again. */
import { Button } from "@mantine/core";
import { versions } from "@shared/api/drafts";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { useMay } from "../../may";

export function Archived({ studyKey }: { readonly studyKey: string }): JSX.Element {
  const { t } = useTexts();
  const may = useMay();
  const queries = useQueryClient();
  const restore = useMutation({
    mutationFn: () => versions.restore(studyKey),
    onSuccess: () => queries.invalidateQueries({ queryKey: ["studies"] }),
  });
  return (
    <div style={{ marginBottom: 16 }}>
      {restore.isError && <Failure error={restore.error} />}
      <Notice
        tone="warn"
        icon="lock"
        title={t("versions.archived")}
        actions={
          may("design") && (
            <Button
              size="xs"
              variant="default"
              loading={restore.isPending}
              onClick={() => restore.mutate()}
            >
              {t("versions.restore")}
            </Button>
          )
        }
      >
        {t("versions.archived.body")}
      </Notice>
    </div>
  );
}
