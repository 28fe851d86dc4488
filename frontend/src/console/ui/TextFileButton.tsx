/** Choose a file with text in it; one that has none, such as a picture, is refused by its name. */
import { Button, FileButton } from "@mantine/core";
import { textOf } from "@shared/api/request";
import { isText } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";

interface TextFileButtonProps {
  /** The extensions and types that the browser offers. */
  readonly accept: string;
  readonly onText: (text: string) => void;
}

export function TextFileButton({ accept, onText }: TextFileButtonProps): JSX.Element {
  const { t } = useTexts();
  const [refused, setRefused] = useState<string | null>(null);
  const [failure, setFailure] = useState<unknown>(null);
  const read = async (file: File | null): Promise<void> => {
    if (file === null) return;
    try {
      const text = await textOf(file);
      setFailure(null);
      setRefused(isText(text) ? null : file.name);
      if (isText(text)) onText(text);
    } catch (error) {
      setFailure(error);
    }
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
      {failure !== null && <Failure error={failure} />}
      {refused !== null && (
        <Notice tone="bad" title={t("import.noText", { name: refused })}>
          {t("import.noText.body")}
        </Notice>
      )}
    </>
  );
}
