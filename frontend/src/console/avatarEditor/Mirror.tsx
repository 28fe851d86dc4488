/** Copying one side of the body to the other: of which parts, and what it has changed. */
import { Button, Menu } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import { partOf, SECTIONS, type Section, sectionOf } from "./axes";
import { mirror } from "./operations";
import type { Work, WorkState } from "./useWork";

const SIDES = ["left_to_right", "right_to_left", "swap"] as const;
const ONE_WAY = ["left_to_right", "right_to_left"] as const;
/** What can be mirrored alone; the operation takes a group with its counterpart. */
const LIMBS = { arms: "left_arm", fingers: "left_fingers", legs: "left_leg" } as const;

/** What was mirrored, and what the work was before. */
interface Made {
  readonly label: string;
  readonly hashBefore: string;
}

export interface Mirroring {
  readonly made: Made | null;
  readonly mirror: (
    direction: (typeof SIDES)[number],
    targets: readonly string[],
    label: string,
  ) => void;
  readonly forget: () => void;
}

export function useMirroring(work: Work): Mirroring {
  const [made, setMade] = useState<Made | null>(null);
  return {
    made,
    mirror: (direction, targets, label) => {
      const hashBefore = work.contentHash;
      void work
        .edit(mirror(direction, targets), label)
        .then((isMade) => setMade(isMade ? { label, hashBefore } : null));
    },
    forget: () => setMade(null),
  };
}

interface MirrorMenuProps {
  readonly mirroring: Mirroring;
  readonly selected: ReadonlySet<string>;
}

export function MirrorMenu({ mirroring, selected }: MirrorMenuProps): JSX.Element {
  const { t } = useTexts();
  const parts = [...new Set([...selected].map(partOf))];
  const some: readonly (readonly [name: string, targets: readonly string[]])[] = [
    ...(Object.keys(LIMBS) as (keyof typeof LIMBS)[]).map(
      (limb) => [t(`avatars.mirror.${limb}`), [LIMBS[limb]]] as const,
    ),
    ...(parts.length === 0 ? [] : [[t("avatars.mirror.selected"), parts] as const]),
  ];
  return (
    <Menu position="bottom-end" withinPortal>
      <Menu.Target>
        <Button size="xs" variant="default" rightSection={<Icon name="down" size={14} />}>
          {t("avatars.mirror")}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Label>{t("bodyGroup.all")}</Menu.Label>
        {SIDES.map((direction) => {
          const label = t(`avatars.mirror.${direction}`);
          return (
            <Menu.Item key={direction} onClick={() => mirroring.mirror(direction, ["all"], label)}>
              {label}
            </Menu.Item>
          );
        })}
        <Menu.Divider />
        <Menu.Label>{t("avatars.mirror.only")}</Menu.Label>
        {some.flatMap(([name, targets]) =>
          ONE_WAY.map((direction) => {
            const label = t(`avatars.mirror.only.${direction}`, { name });
            return (
              <Menu.Item key={label} onClick={() => mirroring.mirror(direction, targets, label)}>
                {label}
              </Menu.Item>
            );
          }),
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

interface MirroredProps {
  readonly mirroring: Mirroring;
  readonly work: Work;
  /** The message goes, and with it the button that has the focus. */
  readonly onGone: () => void;
}

/** What mirroring has changed, until something else is done. */
export function Mirrored({ mirroring, work, onGone }: MirroredProps): JSX.Element | null {
  const texts = useTexts();
  const { t } = texts;
  const { made, forget } = mirroring;
  if (made === null) return null;
  const isChanged = work.label === made.label && work.contentHash !== made.hashBefore;
  if (!isChanged && work.contentHash !== made.hashBefore) return null;
  const counts = isChanged ? changedBySection(work) : [];
  const words = counts.map(([section, count]) =>
    t("avatars.mirrored.values", { count, name: groupName(texts, section) }),
  );
  const close = (act: () => void) => () => {
    onGone();
    forget();
    act();
  };
  return (
    <Notice
      tone="info"
      title={
        isChanged
          ? t("avatars.mirrored", { what: made.label, values: words.join(", ") })
          : t("avatars.mirrored.nothing", { what: made.label })
      }
      actions={
        <>
          {isChanged && (
            <Button size="xs" variant="default" mr={6} onClick={close(work.undo)}>
              {t("avatars.mirrored.undo")}
            </Button>
          )}
          <Button size="xs" variant="default" onClick={close(() => undefined)}>
            {t("action.understood")}
          </Button>
        </>
      }
    />
  );
}

/** How many values of each part of the body the last edit has changed. */
function changedBySection({ changed }: WorkState): readonly (readonly [Section, number])[] {
  const sections = changed.map(
    ({ part, groups }) => SECTIONS.find((one) => groups.includes(one)) ?? sectionOf(part ?? ""),
  );
  return SECTIONS.map(
    (section) => [section, sections.filter((one) => one === section).length] as const,
  ).filter(([, count]) => count > 0);
}
