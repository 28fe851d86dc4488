/** A button of a transport: an icon with its name beside it. */
import { ActionIcon, Tooltip } from "@mantine/core";
import type { JSX } from "react";
import { Icon } from "../ui/Icon";

interface PressProps {
  readonly icon: "back" | "forward" | "play" | "pause";
  readonly name: string;
  readonly filled?: boolean;
  readonly onClick: () => void;
}

export function Press({ icon, name, filled = false, onClick }: PressProps): JSX.Element {
  return (
    <Tooltip label={name}>
      <ActionIcon
        size="lg"
        variant={filled ? "filled" : "default"}
        aria-label={name}
        onClick={onClick}
      >
        <Icon name={icon} size={18} />
      </ActionIcon>
    </Tooltip>
  );
}
