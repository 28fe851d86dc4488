/** Unsaved changes: a confirmation before the page is left. */
import { Button, Group, Modal, Text } from "@mantine/core";
import { type JSX, useEffect, useState } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";

/**
 * Ask for confirmation before unsaved changes are left: on links of the page, and on closing the
 * tab.
 */
export function LeaveGuard({ unsaved }: { readonly unsaved: boolean }): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const [target, setTarget] = useState<string | null>(null);
  useEffect(() => {
    if (!unsaved) return;
    const onClick = (event: MouseEvent) => {
      const link = event.target instanceof Element ? event.target.closest("a[href^='#']") : null;
      if (link === null || event.metaKey || event.ctrlKey || event.shiftKey) return;
      event.preventDefault();
      event.stopPropagation();
      setTarget(link.getAttribute("href")?.slice(1) ?? "/");
    };
    const onClose = (event: BeforeUnloadEvent) => event.preventDefault();
    // In the capture phase, before the link itself receives the click.
    document.addEventListener("click", onClick, true);
    window.addEventListener("beforeunload", onClose);
    return () => {
      document.removeEventListener("click", onClick, true);
      window.removeEventListener("beforeunload", onClose);
    };
  }, [unsaved]);
  return (
    <Modal
      opened={target !== null}
      onClose={() => setTarget(null)}
      title={t("editor.leave.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <Text>{t("editor.leave.body")}</Text>
      <Group justify="flex-end" mt="lg">
        <Button variant="default" onClick={() => setTarget(null)}>
          {t("editor.leave.stay")}
        </Button>
        <Button
          onClick={() => {
            setTarget(null);
            if (target !== null) navigate(target);
          }}
        >
          {t("editor.leave.go")}
        </Button>
      </Group>
    </Modal>
  );
}
