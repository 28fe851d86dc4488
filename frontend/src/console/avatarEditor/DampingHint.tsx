/** What a changed stiffness asks for: a damping that fits, or a limb that gives way instead. */
import { Anchor, Button } from "@mantine/core";
import { number } from "@shared/format";
import type { JSX } from "react";
import { axisName } from "../avatarChanges/axes";
import { useTexts } from "../i18n";
import type { Operation } from "./api";
import { type AvatarFile, UNITS } from "./axes";
import { unfitting } from "./damping";
import classes from "./Editor.module.css";
import { setField } from "./operations";

interface DampingHintProps {
  readonly base: AvatarFile;
  readonly configuration: AvatarFile;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
  /** Open the setting that lets a group give way. */
  readonly onCompliance: () => void;
}

const DIGITS = 4;

export function DampingHint(props: DampingHintProps): JSX.Element {
  const { base, configuration, edit, onCompliance } = props;
  const texts = useTexts();
  const { t, language } = texts;
  const found = unfitting(base, configuration);
  const [first] = found;
  return (
    <div role="status" className={classes.damping}>
      {first !== undefined && (
        <>
          <p>
            {found.length === 1
              ? t("avatars.damping.one", {
                  name: axisName(texts, first.axis),
                  value: `${number(first.damping, language, DIGITS)} ${UNITS.kd_nm_s_per_rad}`,
                })
              : t("avatars.damping.several", { count: found.length })}{" "}
            {t("avatars.damping.why")}
          </p>
          <Button
            size="compact-xs"
            variant="default"
            onClick={() =>
              void edit(
                found.flatMap(({ axis, damping }) => setField([axis], "kd_nm_s_per_rad", damping)),
                t("avatars.did.damping"),
              )
            }
          >
            {t("avatars.damping.set")}
          </Button>
          <span className={classes.soft}>
            {t("avatars.damping.instead")}{" "}
            <Anchor
              component="button"
              type="button"
              inherit
              underline="always"
              onClick={onCompliance}
            >
              {t("avatars.compliance")}
            </Anchor>
          </span>
        </>
      )}
    </div>
  );
}
