/** Answers that were collected elsewhere: the imports so far, and a button for a new one. */
import { Badge, Button, Paper, Title } from "@mantine/core";
import type { AnswerImport } from "@shared/api/imports";
import type { StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { importsQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { ImportDetailDialog } from "./ImportDetailDialog";
import classes from "./Imports.module.css";
import { ImportWizard } from "./ImportWizard";

export function ImportsCard({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const [adding, setAdding] = useState(false);
  const [shown, setShown] = useState<string | null>(null);
  const open = (id: string): void => {
    setAdding(false);
    setShown(id);
  };
  return (
    <Paper>
      <div className={classes.head}>
        <div>
          <Title order={2}>{t("imports.title")}</Title>
          <p className={classes.lead}>{t("imports.lead")}</p>
        </div>
        {can("design") && (
          <Button
            variant="default"
            leftSection={<Icon name="upload" size={18} />}
            onClick={() => setAdding(true)}
          >
            {t("imports.open")}
          </Button>
        )}
      </div>
      <Loaded query={useQuery(importsQuery(study.key))} isShort>
        {(found) =>
          found.length === 0 ? (
            <p className={classes.soft}>{t("imports.none")}</p>
          ) : (
            <List imports={found} onOpen={open} />
          )
        }
      </Loaded>
      <ImportWizard study={study} opened={adding} onClose={() => setAdding(false)} onOpen={open} />
      <ImportDetailDialog studyKey={study.key} id={shown} onClose={() => setShown(null)} />
    </Paper>
  );
}

interface ListProps {
  readonly imports: readonly AnswerImport[];
  readonly onOpen: (id: string) => void;
}

function List({ imports, onOpen }: ListProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <section className={classes.scroll} aria-label={t("imports.title")}>
      <table className={`${classes.table} numbers`}>
        <thead>
          <tr>
            <th scope="col">{t("imports.file")}</th>
            <th scope="col">{t("imports.instrument")}</th>
            <th scope="col">{t("imports.forms")}</th>
            <th scope="col">{t("imports.people")}</th>
            <th scope="col">{t("imports.when")}</th>
            <th scope="col">{t("imports.state")}</th>
          </tr>
        </thead>
        <tbody>
          {imports.map((one) => (
            <tr key={one.id}>
              <th scope="row">
                <button type="button" className={classes.link} onClick={() => onOpen(one.id)}>
                  {one.file_name}
                </button>
              </th>
              <td>{one.instrument}</td>
              <td>{one.forms}</td>
              <td>{one.participants}</td>
              <td>{dateTime(one.imported_at, language)}</td>
              <td>
                <ImportedBadge undone={one.undone_at !== null} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

export function ImportedBadge({ undone }: { readonly undone: boolean }): JSX.Element {
  const { t } = useTexts();
  return (
    <Badge variant={undone ? "default" : "outline"} size="sm" tt="none">
      {t(undone ? "imports.undone" : "imports.imported")}
    </Badge>
  );
}
