/** Which avatars are compared, and whether their feet are locked to the ground. */
import { ActionIcon, Button, Checkbox, Loader, NumberInput } from "@mantine/core";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { avatarOf, MAX_AVATARS, STATURE_LIMITS, statureOf, withAvatar } from "./avatars";
import classes from "./Verification.module.css";

interface AvatarChipsProps {
  readonly avatars: readonly string[];
  readonly lockFeet: boolean;
  readonly busy: boolean;
  readonly onAvatars: (avatars: readonly string[]) => void;
  readonly onLockFeet: (lockFeet: boolean) => void;
}

export function AvatarChips(props: AvatarChipsProps): JSX.Element {
  const { avatars, lockFeet, busy, onAvatars, onLockFeet } = props;
  const { t, language } = useTexts();
  const name = (avatar: string) =>
    t("capture.avatar.cm", { value: number(statureOf(avatar), language) });
  return (
    <div className={classes.choices}>
      <ul className={classes.chips} aria-label={t("verify.avatars")}>
        {avatars.map((avatar) => (
          <li key={avatar} className="numbers">
            {name(avatar)}
            {avatars.length > 1 && (
              <ActionIcon
                variant="subtle"
                color="gray"
                size="sm"
                aria-label={t("verify.avatar.remove", { avatar: name(avatar) })}
                onClick={() => onAvatars(avatars.filter((other) => other !== avatar))}
              >
                <Icon name="close" size={13} />
              </ActionIcon>
            )}
          </li>
        ))}
      </ul>
      {avatars.length < MAX_AVATARS ? (
        <AddAvatar onAdd={(avatar) => onAvatars(withAvatar(avatars, avatar))} />
      ) : (
        <span className={classes.soft}>{t("verify.avatar.most", { count: MAX_AVATARS })}</span>
      )}
      <Checkbox
        label={t("verify.lock")}
        description={t("verify.lock.hint")}
        checked={lockFeet}
        onChange={(event) => onLockFeet(event.currentTarget.checked)}
      />
      {busy && <Loader size="sm" role="status" aria-label={t("verify.busy")} />}
    </div>
  );
}

function AddAvatar({ onAdd }: { readonly onAdd: (avatar: string) => void }): JSX.Element {
  const { t } = useTexts();
  const [stature, setStature] = useState<number | string>("");
  const avatar = avatarOf(stature);
  return (
    <form
      className={classes.add}
      onSubmit={(event) => {
        event.preventDefault();
        if (avatar === null) return;
        onAdd(avatar);
        setStature("");
      }}
    >
      <NumberInput
        size="sm"
        aria-label={t("verify.avatar.stature")}
        placeholder={t("verify.avatar.stature")}
        {...STATURE_LIMITS}
        suffix=" cm"
        decimalScale={1}
        hideControls
        w={140}
        value={stature}
        onChange={setStature}
      />
      <Button type="submit" size="sm" variant="default" disabled={avatar === null}>
        {t("verify.avatar.add")}
      </Button>
    </form>
  );
}
