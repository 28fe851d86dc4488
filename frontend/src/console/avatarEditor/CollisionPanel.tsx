/** What collides: the collider of each part, and which layers of the body touch each other. */
import { Button, Switch } from "@mantine/core";
import { COLLIDING, LAYERS } from "@shared/avatar/anatomy.generated";
import { type JSX, useState } from "react";
import { groupName, layerName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import type { ColliderKind, Operation } from "./api";
import type { AvatarFile } from "./axes";
import classes from "./Editor.module.css";
import { ALL_GROUPS, GroupSelect } from "./GroupSelect";
import { Before, type ComparedPanelProps } from "./panels";

const KINDS = ["simple", "mesh", "none"] as const satisfies readonly ColliderKind[];

export function CollisionPanel(props: ComparedPanelProps): JSX.Element {
  const { configuration, base, edit, isReadOnly } = props;
  const texts = useTexts();
  const { t } = texts;
  const [group, setGroup] = useState("all");
  const hasOthers = Object.keys(configuration.part_colliders).length > 0;
  const set = (targets: string, kind: ColliderKind) =>
    void edit(
      [{ operation: "set_colliders", targets: [targets], kind }],
      t("avatars.did.collider", {
        name: groupName(texts, targets),
        kind: t(`avatarChanges.kind.${kind}`),
      }),
    );
  return (
    <div className={classes.panels}>
      <fieldset className={classes.panel} disabled={isReadOnly}>
        <legend>{t("avatarChanges.colliders")}</legend>
        <div className={classes.row}>
          <GroupSelect
            label={t("avatars.collider.of")}
            groups={ALL_GROUPS}
            value={group}
            onChange={setGroup}
            isDisabled={isReadOnly}
          />
          {KINDS.map((kind) => (
            <Button
              key={kind}
              size="xs"
              variant="default"
              disabled={kind === "mesh" && (configuration.humanoid ?? null) === null}
              onClick={() => set(group, kind)}
            >
              {t(`avatarChanges.kind.${kind}`)}
            </Button>
          ))}
        </div>
        <p className={classes.soft}>{t("avatars.collider.hint")}</p>
        <table className={`${classes.kinds} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("avatars.part")}</th>
              <th scope="col">{t("avatarChanges.kind")}</th>
            </tr>
          </thead>
          <tbody>
            {exceptions(configuration).map(([part, kind]) => (
              <tr key={part}>
                <th scope="row">
                  {part === null
                    ? t(hasOthers ? "avatars.collider.others" : "bodyGroup.all")
                    : groupName(texts, part)}
                </th>
                <td>{t(`avatarChanges.kind.${kind}`)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </fieldset>
      <fieldset className={classes.panel} disabled={isReadOnly}>
        <legend>{t("avatarChanges.layers")}</legend>
        <Switch
          label={t("avatarChanges.selfCollision")}
          checked={configuration.self_collision}
          onChange={(event) =>
            void edit(
              [
                {
                  operation: "set_body",
                  self_collision: event.currentTarget.checked,
                } as Operation,
              ],
              t("avatarChanges.selfCollision"),
            )
          }
        />
        <Before
          isChanged={configuration.self_collision !== base.self_collision}
          value={t(base.self_collision ? "avatarChanges.on" : "avatarChanges.off")}
        />
        <Layers {...props} isOn={configuration.self_collision} />
        <p className={classes.soft}>{t("avatars.layers.hint")}</p>
      </fieldset>
    </div>
  );
}

/** The parts that do not have the body's kind, and first the kind of all others. */
const exceptions = (
  configuration: AvatarFile,
): readonly (readonly [string | null, ColliderKind])[] => [
  [null, configuration.colliders],
  ...Object.entries(configuration.part_colliders),
];

interface LayersProps extends ComparedPanelProps {
  readonly isOn: boolean;
}

/** The lower half of the matrix: each pair of layers once. */
function Layers({ configuration, base, edit, isReadOnly, isOn }: LayersProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  return (
    <div className={classes.matrixScroll}>
      <table className={classes.matrix}>
        <caption className="visually-hidden">{t("avatarChanges.layers")}</caption>
        <thead>
          <tr>
            <td />
            {LAYERS.slice(0, -1).map((column) => (
              <th key={column} scope="col">
                {layerName(texts, column)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {LAYERS.slice(1).map((row, at) => (
            <tr key={row}>
              <th scope="row">{layerName(texts, row)}</th>
              {LAYERS.slice(0, at + 1).map((column) => {
                const name = `${layerName(texts, row)} · ${layerName(texts, column)}`;
                const isColliding = collides(configuration, row, column);
                if (!isSwitchable(row, column)) {
                  return (
                    <td key={column} title={`${name}: ${t("avatars.layers.never")}`}>
                      <span aria-hidden>–</span>
                      <span className="visually-hidden">{t("avatars.layers.never")}</span>
                    </td>
                  );
                }
                const before = collides(base, row, column);
                const wasNow = t("avatars.wasNow", {
                  value: t(before ? "avatarChanges.on" : "avatarChanges.off"),
                });
                const isChanged = before !== isColliding;
                return (
                  <td
                    key={column}
                    data-changed={isChanged || undefined}
                    title={isChanged ? `${name}. ${wasNow}` : name}
                  >
                    <input
                      type="checkbox"
                      aria-label={name}
                      checked={isColliding}
                      disabled={isReadOnly || !isOn}
                      onChange={() =>
                        void edit(
                          [
                            {
                              operation: "set_layers",
                              layers: [column, row],
                              collide: !isColliding,
                            },
                          ],
                          name,
                        )
                      }
                    />
                  </td>
                );
              })}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** The thighs overlap the trunk when somebody sits, so they cannot be made to collide. */
const isSwitchable = (row: string, column: string): boolean =>
  !([row, column].includes("torso") && [row, column].some((one) => one.endsWith("_leg")));

/** Whether two layers collide: as the standard matrix says, unless the configuration differs. */
function collides(configuration: AvatarFile, a: string, b: string): boolean {
  const isPair = (pair: readonly string[]) => pair.includes(a) && pair.includes(b);
  const own = configuration.layers?.findLast(({ layers }) => isPair(layers));
  return own?.collide ?? COLLIDING.some(isPair);
}
