/** The result of the verification in a sentence. */
import type { Verification, Walker } from "@shared/api/captures";
import { number } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { statureOf } from "./avatars";

export function VerificationSummary({
  verification,
}: {
  readonly verification: Verification;
}): JSX.Element {
  const { t, language } = useTexts();
  const { source, avatars } = verification;
  const sourceLifts = liftsOf(source);
  if ([source, ...avatars].every(({ strides }) => strides.length === 0)) {
    return <Notice tone="warn" title={t("verify.noStep")} remedy={t("verify.noStep.body")} />;
  }
  if (!verification.lifts_agree) {
    const differing = avatars
      .filter((avatar) => !avatar.lifts_agree)
      .map((avatar) =>
        t("verify.differ.one", {
          avatar: t("capture.avatar.cm", { value: number(statureOf(avatar.name), language) }),
          ...liftsOf(avatar),
          wantedLeft: sourceLifts.left,
          wantedRight: sourceLifts.right,
        }),
      );
    return (
      <Notice
        tone="warn"
        title={t("verify.differ", { told: differing.join(", ") })}
        remedy={t("verify.differ.remedy")}
      />
    );
  }
  const apart_s = verification.largest_timing_difference_s;
  return (
    <Notice
      tone="info"
      icon="check"
      title={t("verify.agree", sourceLifts)}
      {...(apart_s === null
        ? {}
        : {
            remedy: t("verify.agree.timing", { milliseconds: number(1000 * apart_s, language, 1) }),
          })}
    />
  );
}

export function liftsOf({ strides }: Walker): { readonly left: number; readonly right: number } {
  const left = strides.filter(({ side }) => side === "left").length;
  return { left, right: strides.length - left };
}
