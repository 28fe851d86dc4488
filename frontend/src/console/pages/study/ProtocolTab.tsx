/** The protocol as it was written, read only, with the hash that identifies it. */
import { Button, CopyButton } from "@mantine/core";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { ImportDialog } from "../ImportDialog";
import classes from "./ProtocolTab.module.css";

export function ProtocolTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const [importing, setImporting] = useState(false);
  return (
    <>
      <Notice tone="info" icon={study.frozen ? "lock" : "document"}>
        {t(study.frozen ? "protocol.frozen" : "protocol.open")}
      </Notice>
      <div className={classes.frame} style={{ marginTop: 16 }}>
        <div className={classes.bar}>
          <span>{t("study.version", { version: study.version })}</span>
          <span className={classes.hash} title={study.content_hash}>
            sha256 {study.content_hash}
          </span>
          <div className={classes.buttons}>
            <CopyButton value={study.yaml ?? ""}>
              {({ copied, copy }) => (
                <Button size="xs" variant="default" onClick={copy}>
                  {t(copied ? "action.copied" : "action.copy")}
                </Button>
              )}
            </CopyButton>
            {can("design") && (
              <>
                <Button
                  size="xs"
                  component={Link}
                  href={`/studies/${study.key}/edit`}
                  leftSection={<Icon name="document" size={15} />}
                >
                  {t("versions.edit")}
                </Button>
                <Button
                  size="xs"
                  variant="default"
                  leftSection={<Icon name="upload" size={15} />}
                  onClick={() => setImporting(true)}
                >
                  {t("protocol.newVersion")}
                </Button>
              </>
            )}
          </div>
        </div>
        <Yaml text={study.yaml ?? ""} label={t("study.tab.protocol")} />
      </div>
      <ImportDialog opened={importing} studyKey={study.key} onClose={() => setImporting(false)} />
    </>
  );
}

function Yaml({ text, label }: { readonly text: string; readonly label: string }): JSX.Element {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrollable region has to be focusable
    // biome-ignore lint/a11y/useSemanticElements: a section may not be preformatted
    <pre className={classes.yaml} tabIndex={0} role="region" aria-label={label}>
      {text
        .trimEnd()
        .split("\n")
        .map((line, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: lines of a text that never changes
          <code key={index} className={classes.line}>
            <YamlLine line={line} />
          </code>
        ))}
    </pre>
  );
}

const KEY = /^(\s*(?:- )?)([\w.-]+:)(.*)$/;

function YamlLine({ line }: { readonly line: string }): JSX.Element {
  if (line.trimStart().startsWith("#")) return <span className={classes.comment}>{line}</span>;
  const [, indent, key, rest] = KEY.exec(line) ?? [];
  if (key === undefined) return <>{line === "" ? " " : line}</>;
  return (
    <>
      {indent}
      <span className={classes.keyword}>{key}</span>
      {rest}
    </>
  );
}
