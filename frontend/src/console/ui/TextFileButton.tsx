/** Choose a file with text in it; one that has none, such as a picture, is refused by its name. */
import { Button, FileButton } from "@mantine/core";
import { isText } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";

interface TextFileButtonProps {
  /** The extensions and types that the browser offers. */
  readonly accept: string;
  readonly onText: (text: string) => void;
}

export function TextFileButton({ accept, onText }: TextFileButtonProps): JSX.Element {
  const { t } = useTexts();
  const [refused, setRefused] = useState<string | null>(null);
  const read = async (file: File | null): Promise<void> => {
    if (file === null) return;
    const text = await file.text();
    setRefused(isText(text) ? null : file.name);
    if (isText(text)) onText(text);
  };
  return (
    <>
      <FileButton accept={accept} onChange={(file) => void read(file)}>
        {(props) => (
          <Button {...props} variant="default" leftSection={<Icon name="upload" size={18} />}>
            {t("import.file")}
          </Button>
        )}
      </FileButton>
      {refused !== null && (
        <Notice tone="bad" title={t("import.noText", { name: refused })}>
          {t("import.noText.body")}
        </Notice>
      )}
    </>
  );
}
