/** A dialog that asks for confirmation before a capture is deleted for good. */
import { captures } from "@shared/api/captures";
import { useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { DeleteDialog } from "../ui/DeleteDialog";
import { useShown } from "../ui/page";
import { capturesQuery } from "./queries";

interface DeleteCaptureProps {
  /** Null closes the dialog. */
  readonly capture: { readonly id: string; readonly title: string } | null;
  readonly onClose: () => void;
  readonly onDeleted?: () => void;
}

export function DeleteCapture({ capture, onClose, onDeleted }: DeleteCaptureProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const shown = useShown(capture);
  const id = shown?.id ?? "";
  return (
    <DeleteDialog
      isOpen={capture !== null}
      title={t("captures.delete.title")}
      words={t("captures.delete.body", { name: shown?.title ?? "" })}
      onDelete={() => captures.remove(id)}
      onClose={onClose}
      onDeleted={() => {
        onDeleted?.();
        queries.removeQueries({ queryKey: ["captures", id] });
        return queries.invalidateQueries({ queryKey: capturesQuery.queryKey, exact: true });
      }}
    />
  );
}
