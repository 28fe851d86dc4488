/** The choice of one avatar: one of the paper's three statures, or any other. */
import { NumberInput, SegmentedControl } from "@mantine/core";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { avatarOf, PAPER_AVATARS, STATURE_LIMITS, statureOf } from "./avatars";

interface AvatarChoiceProps {
  readonly avatar: string;
  readonly onAvatar: (avatar: string) => void;
}

const OTHER = "other";

export function AvatarChoice({ avatar, onAvatar }: AvatarChoiceProps): JSX.Element {
  const { t } = useTexts();
  const [other, setOther] = useState(!PAPER_AVATARS.includes(avatar));
  const [typed, setTyped] = useState<number | string>(statureOf(avatar));
  const select = (value: number | string) => {
    const named = avatarOf(value);
    if (named !== null && named !== avatar) onAvatar(named);
  };
  return (
    <>
      <SegmentedControl
        size="xs"
        aria-label={t("capture.avatar")}
        value={other ? OTHER : avatar}
        onChange={(value) => {
          setOther(value === OTHER);
          if (value === OTHER) setTyped(statureOf(avatar));
          else onAvatar(value);
        }}
        data={[
          ...PAPER_AVATARS.map((value) => ({
            value,
            label: t("capture.avatar.cm", { value: statureOf(value) }),
          })),
          { value: OTHER, label: t("capture.avatar.other") },
        ]}
      />
      {other && (
        <NumberInput
          size="xs"
          aria-label={t("verify.avatar.stature")}
          {...STATURE_LIMITS}
          suffix=" cm"
          decimalScale={1}
          w={110}
          value={typed}
          onChange={setTyped}
          onBlur={() => select(typed)}
          onKeyDown={(event) => event.key === "Enter" && select(typed)}
        />
      )}
    </>
  );
}
