/** A list from the session's record in a drawer next to the cockpit; it is loaded when opened. */
import { Drawer } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";

interface RecordDrawerProps {
  readonly title: string;
  readonly opened: boolean;
  readonly onClose: () => void;
  readonly children: ReactNode;
}

export function RecordDrawer({ title, opened, onClose, children }: RecordDrawerProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Drawer
      opened={opened}
      onClose={onClose}
      position="right"
      size="lg"
      title={title}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {opened && children}
    </Drawer>
  );
}
