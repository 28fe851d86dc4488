/** The head of the editor: what is edited, how far it is from what is saved, and what can be done. */
import { Button, type ButtonProps, Title, Tooltip } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import type { AvatarVersionDetail, AvatarView } from "./api";
import classes from "./Editor.module.css";
import { Frozen } from "./UsedBy";
import type { Work } from "./useWork";

/** The way back to the list. */
export function ToAvatars(): JSX.Element {
  const { t } = useTexts();
  return (
    <Link href="/avatars" className={classes.crumbs ?? ""}>
      <Icon name="back" size={16} />
      {t("avatars.title")}
    </Link>
  );
}

interface HeadProps {
  readonly avatar: AvatarView;
  readonly base: AvatarVersionDetail;
  readonly work: Work;
  /** How many changes are not saved. */
  readonly unsaved: number;
  readonly children: ReactNode;
}

export function Head({ avatar, base, work, unsaved, children }: HeadProps): JSX.Element {
  const { t } = useTexts();
  const isChanged = work.contentHash !== base.content_hash;
  return (
    <header className={classes.head}>
      <div>
        <ToAvatars />
        <Title order={1} size="h2">
          {avatar.title}
        </Title>
        <p className={`${classes.meta} numbers`} role="status">
          <code className={classes.key}>{avatar.key}</code>
          {t("avatars.version", { number: base.number })}
          {base.number < avatar.newest.number && (
            <span data-changed>{t("avatars.newer", { number: avatar.newest.number })}</span>
          )}
          <Frozen version={base} />
          <code title={t("avatars.hash", { hash: work.contentHash })}>
            {work.contentHash.slice(0, 12)}
          </code>
          <span data-changed={isChanged || undefined}>
            {isChanged ? t("avatars.changes", { count: unsaved }) : t("avatars.unchanged")}
          </span>
        </p>
      </div>
      {children}
    </header>
  );
}

export function UndoButtons({ work }: { readonly work: Work }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Tooltip label={`${work.undoLabel} (Ctrl+Z)`} disabled={!work.canUndo}>
        <StayingButton
          isOff={!work.canUndo}
          variant="default"
          onClick={work.undo}
          leftSection={<Icon name="redo" size={15} />}
        >
          {t("avatars.undo")}
        </StayingButton>
      </Tooltip>
      <Tooltip label={`${work.redoLabel} (Ctrl+Shift+Z)`} disabled={!work.canRedo}>
        <StayingButton isOff={!work.canRedo} variant="default" onClick={work.redo}>
          {t("avatars.redo")}
        </StayingButton>
      </Tooltip>
    </>
  );
}

interface StayingButtonProps extends ButtonProps {
  readonly isOff: boolean;
  readonly onClick: () => void;
}

/**
 * A button that is often switched off by its own press, as Undo after the last edit. It keeps the
 * focus then, so that the keyboard does not begin again at the top of the page.
 */
export function StayingButton({ isOff, onClick, ...rest }: StayingButtonProps): JSX.Element {
  return (
    <Button
      size="xs"
      {...rest}
      {...(isOff ? { "data-disabled": true } : {})}
      aria-disabled={isOff}
      onClick={() => !isOff && onClick()}
    />
  );
}
