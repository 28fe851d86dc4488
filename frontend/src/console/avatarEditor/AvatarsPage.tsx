/** All avatars of the lab, and a new one made from any of them. */
import { Button, Modal, Select, Stack, Table, Text, TextInput, Title } from "@mantine/core";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link, useLocation } from "wouter";
import { nameOf } from "../account";
import { type AvatarSummary, avatarsQuery } from "../bodies/queries";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { DialogButtons } from "../ui/DialogButtons";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { ListTable } from "../ui/tables";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import { avatarQuery, avatars } from "./api";
import classes from "./Editor.module.css";
import { JUST_MADE } from "./justMade";
import { originOf } from "./origin";
import { keyFrom } from "./SaveDialog";

export function AvatarsPage(): JSX.Element {
  const { t, language } = useTexts();
  useTitle(t("avatars.title"));
  const canWrite = usePermissions()("body");
  const [isNew, setNew] = useState(false);
  return (
    <>
      <div className={classes.listHead}>
        <div>
          <Title order={1}>{t("avatars.title")}</Title>
          <Text c="dimmed">{t("avatars.lead")}</Text>
        </div>
        {canWrite && (
          <Button leftSection={<Icon name="add" size={16} />} onClick={() => setNew(true)}>
            {t("avatars.new")}
          </Button>
        )}
      </div>
      <Loaded query={useQuery(avatarsQuery)}>
        {(all) => (
          <>
            <ListTable
              hasActions={false}
              columns={[
                t("avatars.save.title"),
                t("avatars.newest"),
                t("avatars.axes"),
                t("avatars.sessions"),
                t("avatars.by"),
              ]}
            >
              {all.map((one) => (
                <Table.Tr key={one.key}>
                  <Table.Td>
                    <Link href={`/avatars/${one.key}`} className={classes.avatarLink ?? ""}>
                      {one.title}
                    </Link>
                    <code className={classes.key}>{one.key}</code>
                  </Table.Td>
                  <Table.Td>
                    {t("avatars.version", { number: one.newest.number })} ·{" "}
                    {originOf(one.newest, one.key, all, t)}
                  </Table.Td>
                  <Table.Td className="numbers">
                    {one.axes === null
                      ? t("avatars.damaged")
                      : one.locked_axes === 0
                        ? one.axes
                        : t("avatars.axes.locked", {
                            count: one.axes,
                            locked: one.locked_axes ?? 0,
                          })}
                  </Table.Td>
                  <Table.Td className="numbers">{one.sessions}</Table.Td>
                  <Table.Td>
                    {nameOf(one.newest.by)}, {dateTime(one.newest.at, language)}
                  </Table.Td>
                </Table.Tr>
              ))}
            </ListTable>
            <NewAvatar all={all} isOpen={isNew} onClose={() => setNew(false)} />
          </>
        )}
      </Loaded>
    </>
  );
}

interface NewAvatarProps {
  readonly all: readonly AvatarSummary[];
  readonly isOpen: boolean;
  readonly onClose: () => void;
}

/** A key for a title without Latin letters, such as one in Japanese: `avatar`, `avatar_2`, ... */
function freeKey(all: readonly { readonly key: string }[]): string {
  const taken = new Set(all.map(({ key }) => key));
  const numbered = (number: number): string => {
    const key = number === 1 ? "avatar" : `avatar_${number}`;
    return taken.has(key) ? numbered(number + 1) : key;
  };
  return numbered(1);
}

function NewAvatar({ all, isOpen, onClose }: NewAvatarProps): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  const [title, setTitle] = useState("");
  const [base, setBase] = useState<string | null>(null);
  const from = base ?? all.find(({ key }) => key === "standard")?.key ?? all[0]?.key ?? "";
  const key = title.trim() === "" ? "" : keyFrom(title) || freeKey(all);
  const add = useMutation({
    mutationFn: async () => {
      const { newest } = await queries.fetchQuery(avatarQuery(from));
      const note = t("avatars.new.note", { key: from, number: newest.number });
      return avatars.add(key, title.trim(), note, newest.configuration, "by_hand");
    },
    onSuccess: (made) => {
      queries.setQueryData(avatarQuery(made.key).queryKey, made);
      void queries.invalidateQueries({ queryKey: avatarsQuery.queryKey, exact: true });
      navigate(`/avatars/${made.key}`, { state: JUST_MADE });
    },
  });
  const submit = useSingleSubmit(add, { isReused: true });
  const close = () => {
    add.reset();
    onClose();
  };
  const isTaken = all.some((one) => one.key === key);
  return (
    <Modal
      opened={isOpen}
      onClose={close}
      title={t("avatars.new")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (key !== "" && !isTaken) submit();
        }}
      >
        <Stack>
          <TextInput
            data-autofocus
            label={t("avatars.save.title")}
            description={key === "" ? t("avatars.save.key.hint") : t("avatars.new.key", { key })}
            value={title}
            maxLength={200}
            error={isTaken ? t("avatars.new.taken", { key }) : null}
            onChange={(event) => setTitle(event.currentTarget.value)}
          />
          <Select
            label={t("avatars.new.from")}
            allowDeselect={false}
            value={from}
            onChange={setBase}
            data={all.map((one) => ({ value: one.key, label: `${one.title} (${one.key})` }))}
          />
          {add.isError && <Failure error={add.error} />}
          <DialogButtons
            label={t("avatars.new.do")}
            isGrave={false}
            isReady={key !== "" && !isTaken}
            isSending={add.isPending}
            onCancel={close}
          />
        </Stack>
      </form>
    </Modal>
  );
}
