/** Say in words what was changed about a running avatar. */
import type { AvatarChanges } from "@shared/api/types";
import { number } from "@shared/format";
import type { Key, useTexts } from "../i18n";
import { axisName } from "./axes";
import { avatarChangesEn } from "./texts";

type Texts = ReturnType<typeof useTexts>;

const has = (key: string): key is keyof typeof avatarChangesEn =>
  Object.hasOwn(avatarChangesEn, key);

/** The 22 joints of the skeleton, whose names are among those of the joint maps. */
const JOINTS =
  /^(Hips|Spine|Chest|UpperChest|Neck|Head|(Left|Right)(Shoulder|UpperArm|LowerArm|Hand|UpperLeg|LowerLeg|Foot|Toes))$/;

/** The name of a body group or part; of a name that is neither, its words. */
export function groupName({ t }: Pick<Texts, "t">, group: string): string {
  if (has(`bodyGroup.${group}`)) return t(`bodyGroup.${group}` as Key);
  if (JOINTS.test(group)) return t(`joint.${group}` as Key);
  const [, finger, segment] = FINGER.exec(group) ?? [];
  if (finger === undefined) return group.replace(/([a-z])([A-Z])/g, "$1 $2");
  return t(`avatarChanges.${segment}` as Key, { finger: t(`axis.joint.${finger}` as Key) });
}

const FINGER = /^((?:Left|Right)(?:Thumb|Index|Middle|Ring|Little))(Proximal|Intermediate|Distal)$/;

export const layerName = ({ t }: Pick<Texts, "t">, layer: string): string =>
  has(`bodyLayer.${layer}`) ? t(`bodyLayer.${layer}` as Key) : layer;

/** Each change as a short phrase, in the order of the form. */
export function changeWords(texts: Texts, changes: AvatarChanges | null | undefined): string[] {
  if (changes === null || changes === undefined) return [];
  const { t, language } = texts;
  const group = (name: string) => groupName(texts, name);
  const of = (value: number) => number(value, language, 3);
  const words: string[] = [];
  if (changes.gravity != null) {
    words.push(t(changes.gravity ? "avatarChanges.say.gravityOn" : "avatarChanges.say.gravityOff"));
  }
  if (changes.self_collision != null) {
    words.push(
      t(changes.self_collision ? "avatarChanges.say.selfOn" : "avatarChanges.say.selfOff"),
    );
  }
  for (const one of changes.released ?? []) {
    words.push(t("avatarChanges.say.released", { group: group(one) }));
  }
  for (const { group: name, held_deg } of changes.casts ?? []) {
    const angles = Object.entries(held_deg ?? {}).map(
      ([axis, angle]) => `${axisName(texts, axis)} ${of(angle)}°`,
    );
    words.push(
      angles.length === 0
        ? t("avatarChanges.say.cast", { group: group(name) })
        : t("avatarChanges.say.castAt", { group: group(name), angles: angles.join(", ") }),
    );
  }
  for (const { group: name, kind } of changes.colliders ?? []) {
    const values = { group: group(name), kind: t(`avatarChanges.kind.${kind}`) };
    words.push(t("avatarChanges.say.collider", values));
  }
  for (const { layers, collide } of changes.layers ?? []) {
    const values = { first: layerName(texts, layers[0]), second: layerName(texts, layers[1]) };
    words.push(t(collide ? "avatarChanges.say.layersOn" : "avatarChanges.say.layersOff", values));
  }
  for (const gain of changes.gains ?? []) {
    const parts: string[] = [];
    const say = (value: number | null | undefined, key: Key, as: "factor" | "value") => {
      if (value != null) parts.push(t(key, { [as]: of(value) }));
    };
    say(gain.kp_factor, "avatarChanges.say.kp", "factor");
    say(gain.kd_factor, "avatarChanges.say.kd", "factor");
    say(gain.max_torque_factor, "avatarChanges.say.torque", "factor");
    say(gain.kp_nm_per_rad, "avatarChanges.say.kpIs", "value");
    say(gain.kd_nm_s_per_rad, "avatarChanges.say.kdIs", "value");
    say(gain.max_torque_nm, "avatarChanges.say.torqueIs", "value");
    const values = { group: group(gain.motors), gains: parts.join(", ") };
    words.push(t("avatarChanges.say.gains", values));
  }
  return words;
}
