/** The left half of the editor: the study as a form, one section at a time. */
import { Tabs } from "@mantine/core";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import classes from "./Editor.module.css";
import { ListField, ObjectFields } from "./fields/SpecField";
import { TextsSection } from "./fields/Texts";
import { useForm, useLabels, useValue } from "./formContext";
import type { ObjectSpec, Spec } from "./schema";
import { fieldsOf, SECTIONS, type Section, sectionOf } from "./sections";

export function Form({ spec }: { readonly spec: ObjectSpec }): JSX.Element {
  const { t } = useTexts();
  const { problems } = useForm();
  const [section, setSection] = useState<Section>("basics");
  const counts = new Map<Section, number>();
  for (const problem of problems) {
    const at = sectionOf(problem);
    counts.set(at, (counts.get(at) ?? 0) + 1);
  }
  return (
    <Tabs
      variant="pills"
      value={section}
      onChange={(value) => setSection((value ?? "basics") as Section)}
      keepMounted={false}
      classNames={{ list: classes.sections ?? "", panel: classes.panel ?? "" }}
    >
      <Tabs.List>
        {SECTIONS.map((name) => (
          <Tabs.Tab key={name} value={name}>
            {t(`section.${name}`)}
            {counts.has(name) && (
              <span className={classes.count}>
                {counts.get(name)}
                <span className="visually-hidden">{t("editor.problemsHere")}</span>
              </span>
            )}
          </Tabs.Tab>
        ))}
      </Tabs.List>
      <Tabs.Panel value={section}>
        <p className={classes.lead}>{t(`section.${section}.lead`)}</p>
        <Content section={section} spec={spec} />
      </Tabs.Panel>
    </Tabs>
  );
}

interface ContentProps {
  readonly section: Section;
  readonly spec: ObjectSpec;
}

function Content({ section, spec }: ContentProps): JSX.Element {
  switch (section) {
    case "procedure":
      return <ProcedureSection spec={spec} />;
    case "tasks":
      return <Inner spec={spec} path={["procedure", "block", "phases"]} />;
    case "safety":
      return (
        <>
          <Inner spec={spec} path={["procedure", "block", "after"]} />
          <ObjectFields path={[]} spec={fieldsOf(section, spec)} />
        </>
      );
    case "texts":
      return <TextsSection />;
    default:
      return <ObjectFields path={[]} spec={fieldsOf(section, spec)} />;
  }
}

const inside = (spec: Spec | undefined, name: string): Spec | undefined =>
  spec?.kind === "object" ? spec.fields.find((field) => field.name === name)?.spec : undefined;

/** One list that is nested deeper in the file. */
function Inner({ spec, path }: { readonly spec: ObjectSpec; readonly path: readonly string[] }) {
  const labels = useLabels();
  const found = path.reduce<Spec | undefined>(inside, spec);
  return found?.kind === "list" ? (
    <ListField path={path} spec={found} label={labels.field(path.slice(-2).join("."))} />
  ) : null;
}

/** The steps before, in and after the blocks; the timed phases have a section of their own. */
function ProcedureSection({ spec }: { readonly spec: ObjectSpec }): JSX.Element | null {
  const { t } = useTexts();
  const crossing = useValue(["procedure", "block", "crossing"]);
  const procedure = inside(spec, "procedure");
  const block = inside(procedure, "block");
  if (procedure?.kind !== "object" || block?.kind !== "object") return null;
  return (
    <>
      <ObjectFields path={["procedure"]} spec={procedure} without={["block"]} />
      <fieldset className={classes.group}>
        <legend>{t("section.procedure.block")}</legend>
        <ObjectFields path={["procedure", "block"]} spec={block} without={["phases", "after"]} />
        {crossing !== undefined && crossing !== null && (
          <p className={classes.lead}>{t("section.procedure.road")}</p>
        )}
      </fieldset>
    </>
  );
}
