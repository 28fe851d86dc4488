/** Save the work: as the next version of the avatar, or as an avatar of its own. */
import { Button, Group, Modal, Radio, Stack, Textarea, TextInput } from "@mantine/core";
import { isApiError } from "@shared/api/request";
import { dateTime } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { nameOf } from "../account";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { DialogButtons } from "../ui/DialogButtons";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import { type AvatarView, avatarQuery, avatars, type Made } from "./api";
import { type AvatarFile, differences } from "./axes";
import { Differences } from "./Differences";
import classes from "./Editor.module.css";
import { changedByBoth } from "./merge";

interface SaveDialogProps {
  readonly isOpen: boolean;
  readonly onClose: () => void;
  readonly avatarKey: string;
  readonly title: string;
  /** The version that the work started from, and what it holds. */
  readonly basedOn: number;
  readonly base: AvatarFile;
  readonly configuration: AvatarFile;
  /** How the values were found. */
  readonly made: Made;
  readonly onSaved: (saved: AvatarView) => void;
  /** Put one's own changes onto what somebody else has saved; false if that cannot be done. */
  readonly onFollow: (saved: AvatarView) => Promise<boolean>;
}

/** The avatar that comes with Reembody: who saves a version of it no longer gets a release's. */
const SHIPPED = "standard";

export const keyFrom = (title: string): string =>
  title
    .toLowerCase()
    .normalize("NFKD")
    .replace(/[^a-z0-9]+/g, "_")
    .replace(/^[^a-z]+|_+$/g, "")
    .slice(0, 80);

export function SaveDialog(props: SaveDialogProps): JSX.Element {
  const { isOpen, onClose, avatarKey, title, basedOn, base, configuration, onSaved, onFollow } =
    props;
  const { t } = useTexts();
  const queries = useQueryClient();
  const [as, setAs] = useState<"version" | "avatar">(avatarKey === SHIPPED ? "avatar" : "version");
  const [note, setNote] = useState("");
  const [name, setName] = useState("");
  const [written, setWritten] = useState<string | null>(null);
  const key = written ?? keyFrom(name);
  const save = useMutation({
    mutationFn: (on: number) =>
      as === "version"
        ? avatars.addVersion(avatarKey, on, note, configuration, props.made)
        : avatars.add(key, name.trim(), note, configuration, props.made),
    onSuccess: async (saved) => {
      queries.setQueryData(avatarQuery(saved.key).queryKey, saved);
      await queries.invalidateQueries({ queryKey: ["avatars"], exact: true });
      setNote("");
      setName("");
      setWritten(null);
      onSaved(saved);
    },
  });
  const submit = useSingleSubmit(save, { isReused: true });
  const close = () => {
    save.reset();
    onClose();
  };
  const isStale = isApiError(save.error, "stale");
  const isWrong = as === "avatar" && !/^[a-z][a-z0-9_-]{0,79}$/.test(key);
  const isReady = as === "version" || (name.trim() !== "" && !isWrong);
  const changed = differences(base, configuration).length;
  return (
    <Modal
      opened={isOpen}
      onClose={close}
      size="lg"
      title={t("avatars.save")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (isReady) submit(basedOn);
        }}
      >
        <Stack gap="sm">
          <Radio.Group
            label={t("avatars.save.as")}
            value={as}
            onChange={(value) => setAs(value as typeof as)}
          >
            <Stack gap={6} mt={6}>
              <Radio value="version" label={t("avatars.save.version", { title })} />
              <Radio value="avatar" label={t("avatars.save.avatar")} />
            </Stack>
          </Radio.Group>
          {as === "version" && avatarKey === SHIPPED && (
            <p className={classes.soft}>{t("avatars.save.shipped", { title })}</p>
          )}
          {as === "avatar" && (
            <>
              <TextInput
                data-autofocus
                label={t("avatars.save.title")}
                value={name}
                maxLength={200}
                onChange={(event) => setName(event.currentTarget.value)}
              />
              <TextInput
                label={t("avatars.save.key")}
                description={t("avatars.save.key.hint")}
                value={key}
                maxLength={80}
                error={
                  (key !== "" || name.trim() !== "") && isWrong ? t("bodies.name.wrong") : null
                }
                onChange={(event) => setWritten(event.currentTarget.value)}
              />
            </>
          )}
          <Textarea
            {...(as === "version" ? { "data-autofocus": true } : {})}
            label={t("avatars.save.note")}
            value={note}
            maxLength={2000}
            autosize
            minRows={2}
            onChange={(event) => setNote(event.currentTarget.value)}
          />
          <details className={classes.more}>
            <summary>{t("avatars.changes", { count: changed })}</summary>
            <Differences
              label={t("avatars.changes", { count: changed })}
              before={base}
              after={configuration}
              columns={[t("avatars.before"), t("avatars.after")]}
            />
          </details>
          {isStale ? (
            <Conflict
              avatarKey={avatarKey}
              configuration={configuration}
              start={{ column: t("avatars.version", { number: basedOn }), file: base }}
              onFollow={async (theirs) => {
                save.reset();
                if (!(await onFollow(theirs))) close();
              }}
              onSave={(newest) => submit(newest)}
              onOther={() => {
                save.reset();
                setAs("avatar");
              }}
            />
          ) : (
            <>
              {save.isError && <Failure error={save.error} />}
              <DialogButtons
                label={t("avatars.save")}
                isGrave={false}
                isReady={isReady}
                isSending={save.isPending}
                onCancel={close}
              />
            </>
          )}
        </Stack>
      </form>
    </Modal>
  );
}

interface ConflictProps {
  readonly avatarKey: string;
  readonly configuration: AvatarFile;
  /** The version that both began from. */
  readonly start: { readonly column: string; readonly file: AvatarFile };
  readonly onFollow: (theirs: AvatarView) => void;
  readonly onSave: (newest: number) => void;
  readonly onOther: () => void;
}

/** Somebody saved meanwhile: both are kept, and the reader decides which comes next. */
function Conflict(props: ConflictProps): JSX.Element {
  const { avatarKey, configuration, start, onFollow, onSave, onOther } = props;
  const { t, language } = useTexts();
  const { data } = useQuery({ ...avatarQuery(avatarKey), staleTime: 0, refetchOnMount: "always" });
  if (data === undefined) return <p role="status">{t("avatars.conflict")}</p>;
  const { newest } = data;
  const both = changedByBoth(start.file, configuration, newest.configuration).length;
  return (
    <Notice
      tone="warn"
      title={t("avatars.conflict")}
      actions={
        <Group gap="xs">
          <Button size="xs" onClick={() => onFollow(data)}>
            {t("avatars.conflict.follow", { number: newest.number })}
          </Button>
          <Button size="xs" variant="default" onClick={onOther}>
            {t("avatars.conflict.other")}
          </Button>
          <Button size="xs" variant="default" onClick={() => onSave(newest.number)}>
            {t("avatars.conflict.mine", { number: newest.number + 1 })}
          </Button>
        </Group>
      }
    >
      <p>
        {t("avatars.conflict.body", {
          number: newest.number,
          by: nameOf(newest.by),
          at: dateTime(newest.at, language),
          note: newest.note,
        })}
      </p>
      <Differences
        label={t("avatars.conflict.differences")}
        before={newest.configuration}
        after={configuration}
        columns={[t("avatars.conflict.theirs"), t("avatars.conflict.yours")]}
        start={start}
      />
      <p>
        {t("avatars.conflict.means", { number: newest.number })}{" "}
        {both > 0 && t("avatars.conflict.both", { count: both })}
      </p>
    </Notice>
  );
}
