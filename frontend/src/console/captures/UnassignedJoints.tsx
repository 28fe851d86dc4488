/** The joints that a joint map leaves out, on both sides. */
import { Title } from "@mantine/core";
import type { JointMapView } from "@shared/api/captures";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";
import classes from "./JointMap.module.css";
import type { BodyMap } from "./jointMapEdit";

const MAX_SHOWN = 24;

interface UnassignedJointsProps {
  readonly present: BodyMap;
  readonly view: JointMapView;
}

export function UnassignedJoints({ present, view }: UnassignedJointsProps): JSX.Element {
  const { t } = useTexts();
  const used = new Set(Object.values(present));
  const body = view.body_joints.filter((joint) => present[joint] === undefined);
  const rig = view.rig_joints.filter((name) => !used.has(name));
  return (
    <section className={classes.left}>
      <div>
        <Title order={2} size="h4" fz="0.9375rem">
          {t("map.left.body")}
        </Title>
        {body.length === 0 ? (
          <p className={classes.none}>{t("map.left.body.none")}</p>
        ) : (
          <>
            <Chips names={body.map((joint) => t(`joint.${joint}` as Key))} />
            <p className={classes.none}>{t("map.left.body.hint")}</p>
          </>
        )}
      </div>
      <div>
        <Title order={2} size="h4" fz="0.9375rem">
          {t("map.left.rig")}
        </Title>
        {rig.length === 0 ? (
          <p className={classes.none}>{t("map.left.rig.none")}</p>
        ) : rig.length <= MAX_SHOWN ? (
          <Chips names={rig} />
        ) : (
          <details>
            <summary>{t("map.left.rig.toggle", { count: rig.length })}</summary>
            <Chips names={rig} />
          </details>
        )}
      </div>
    </section>
  );
}

function Chips({ names }: { readonly names: readonly string[] }): JSX.Element {
  return (
    <ul className={classes.chips}>
      {names.map((name) => (
        <li key={name}>{name}</li>
      ))}
    </ul>
  );
}
