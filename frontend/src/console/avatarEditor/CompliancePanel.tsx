/** How body groups give way when something pushes them, and what they return to. */
import { Button, NumberInput, SegmentedControl } from "@mantine/core";
import { number } from "@shared/format";
import { Fragment, type JSX, useEffect, useId, useState } from "react";
import { groupName } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import type { Operation } from "./api";
import {
  axesOf,
  type Compliance,
  complianceOf,
  isIn,
  LIMBS,
  SECTIONS,
  type Section,
  STIFF,
} from "./axes";
import classes from "./Editor.module.css";
import { Before, Choice, type ComparedPanelProps } from "./panels";

type Softness = Omit<Extract<Operation, { operation: "set_compliance" }>, "operation" | "targets">;

const LEAST_PERCENT = 1;
const SPACES = ["local", "world"] as const;
const TARGETS = ["joint", "world"] as const;

export function CompliancePanel(props: ComparedPanelProps): JSX.Element {
  const { configuration, base, edit, isReadOnly } = props;
  const texts = useTexts();
  const { t, language } = texts;
  const [refused, setRefused] = useState<{ group: Section; percent: number } | null>(null);
  const lead = useId();
  const now = complianceOf(configuration);
  const before = complianceOf(base);
  const groups = SECTIONS.filter((group) => axesOf(configuration, group).length > 0);
  const isSoft = groups.some((group) => !isStiff(now[group]));
  const late = LIMBS.filter((limb) =>
    Object.keys(configuration.delays_ms ?? {}).some((part) => isIn(limb, part)),
  );
  const set = (targets: readonly string[], values: Softness, label: string) =>
    void edit([{ operation: "set_compliance", targets, ...values } as Operation], label);
  const setStiffness = (group: Section, percent: number) => {
    const isPossible = percent >= LEAST_PERCENT && percent <= STIFF.stiffness_percent;
    setRefused(isPossible ? null : { group, percent });
    if (!isPossible || percent === now[group].stiffness_percent) return;
    const label = t("avatars.did.stiffness", {
      name: groupName(texts, group),
      percent: number(percent, language, 4),
    });
    set([group], { stiffness_percent: percent }, label);
  };
  return (
    <fieldset
      className={`${classes.panel} ${classes.whole}`}
      disabled={isReadOnly}
      aria-describedby={lead}
    >
      <legend>{t("avatars.compliance")}</legend>
      <p className={classes.soft} id={lead}>
        {t("avatars.compliance.lead")}
      </p>
      <table
        className={`${classes.kinds} ${classes.yielding}`}
        aria-label={t("avatars.compliance")}
      >
        <thead>
          <tr>
            <th scope="col">{t("avatars.compliance.group")}</th>
            <th scope="col">{t("avatars.compliance.stiffness_percent")}</th>
            <th scope="col">{t("avatars.compliance.targets")}</th>
          </tr>
        </thead>
        <tbody>
          {groups.map((group) => (
            <Fragment key={group}>
              <tr>
                <th scope="row">{groupName(texts, group)}</th>
                <td>
                  <Stiffness
                    group={group}
                    percent={now[group].stiffness_percent}
                    before={before[group].stiffness_percent}
                    isRefused={refused?.group === group}
                    onChange={(percent) => setStiffness(group, percent)}
                  />
                </td>
                <td>
                  {isLimb(group) ? (
                    <>
                      <SegmentedControl
                        size="xs"
                        aria-label={t("avatars.compliance.targetsOf", {
                          name: groupName(texts, group),
                        })}
                        disabled={isReadOnly}
                        value={now[group].targets}
                        onChange={(value) =>
                          set(
                            [group],
                            { limb_targets: value as Compliance["targets"] },
                            t("avatars.did.returns", {
                              name: groupName(texts, group),
                              targets: t(`avatars.compliance.${value as Compliance["targets"]}`),
                            }),
                          )
                        }
                        data={TARGETS.map((value) => ({
                          value,
                          label: t(`avatars.compliance.${value}`),
                          disabled: value === "world" && late.includes(group),
                        }))}
                      />
                      <Before
                        isChanged={now[group].targets !== before[group].targets}
                        value={t(`avatars.compliance.${before[group].targets}`)}
                      />
                    </>
                  ) : (
                    <span className={classes.soft}>{t("avatars.compliance.joint")}</span>
                  )}
                </td>
              </tr>
              {refused?.group === group && (
                <tr>
                  <td colSpan={3}>
                    <p className={classes.refused} role="alert">
                      {t("avatars.compliance.range", {
                        name: groupName(texts, group),
                        percent: number(refused.percent, language, 4),
                      })}
                    </p>
                  </td>
                </tr>
              )}
            </Fragment>
          ))}
        </tbody>
      </table>
      {late.map((limb) => (
        <p key={limb} className={classes.soft}>
          {t("avatars.compliance.late", { name: groupName(texts, limb) })}
        </p>
      ))}
      <p className={classes.soft}>{t("avatars.compliance.means")}</p>
      <Choice
        name="targets"
        value={configuration.target_space}
        values={SPACES}
        before={base.target_space}
        isReadOnly={isReadOnly}
        onChange={(space) =>
          void edit(
            [{ operation: "set_body", target_space: space } as Operation],
            t("avatars.targets"),
          )
        }
      />
      <Button
        size="xs"
        variant="default"
        className={classes.start ?? ""}
        disabled={isReadOnly || !isSoft}
        onClick={() => {
          setRefused(null);
          set(
            ["all"],
            { stiffness_percent: STIFF.stiffness_percent, limb_targets: STIFF.targets },
            t("avatars.did.stiff"),
          );
        }}
      >
        {t("avatars.compliance.stiff")}
      </Button>
    </fieldset>
  );
}

const isLimb = (group: string): group is (typeof LIMBS)[number] =>
  (LIMBS as readonly string[]).includes(group);

const isStiff = ({ stiffness_percent, targets }: Compliance): boolean =>
  stiffness_percent === STIFF.stiffness_percent && targets === STIFF.targets;

interface StiffnessProps {
  readonly group: Section;
  readonly percent: number;
  readonly before: number;
  readonly isRefused: boolean;
  readonly onChange: (percent: number) => void;
}

/** A number is taken over by Enter or by leaving the field; Escape takes it back. */
function Stiffness({ group, percent, before, isRefused, onChange }: StiffnessProps): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const [typed, setTyped] = useState<number | string>(percent);
  useEffect(() => setTyped(percent), [percent]);
  const take = () => (typeof typed === "number" ? onChange(typed) : setTyped(percent));
  return (
    <>
      <NumberInput
        size="xs"
        w={96}
        aria-label={t("avatars.compliance.stiffnessOf", { name: groupName(texts, group) })}
        suffix=" %"
        min={LEAST_PERCENT}
        max={STIFF.stiffness_percent}
        clampBehavior="none"
        error={isRefused}
        value={typed}
        onChange={setTyped}
        onBlur={take}
        onKeyDown={(event) => {
          if (event.key === "Enter") take();
          else if (event.key === "Escape") {
            setTyped(percent);
            onChange(percent);
          }
        }}
      />
      <Before isChanged={percent !== before} value={`${number(before, language, 4)} %`} />
    </>
  );
}
