/** All suggestions about the study, by version, and how they were decided. */
import { Button, Group, Menu, Modal, NativeSelect, Stack, Textarea } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { type Suggestion, suggestions } from "@shared/api/records";
import type { StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { suggestionsQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { useSingleSubmit } from "../../ui/useSingleSubmit";
import classes from "./SuggestionsTab.module.css";

export function SuggestionsTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [writing, dialog] = useDisclosure();
  const can = usePermissions();
  const add = can("run") ? (
    <Button variant="default" leftSection={<Icon name="add" size={18} />} onClick={dialog.open}>
      {t("suggest.add")}
    </Button>
  ) : null;
  return (
    <>
      <Loaded query={useQuery(suggestionsQuery(study.key))}>
        {(all) =>
          all.length === 0 ? (
            <EmptyState icon="talk" title={t("suggestions.empty")} action={add}>
              {t("suggestions.empty.body")}
            </EmptyState>
          ) : (
            <>
              <div className={classes.lead}>
                <p>{t("suggestions.lead")}</p>
                {add}
              </div>
              {byVersion(all).map(([version, own]) => (
                <section key={version}>
                  <h2 className={classes.version}>{t("suggestions.version", { version })}</h2>
                  <ul className={classes.list}>
                    {own.map((one) => (
                      <Item key={one.id} one={one} study={study} />
                    ))}
                  </ul>
                </section>
              ))}
            </>
          )
        }
      </Loaded>
      <Modal
        opened={writing}
        onClose={dialog.close}
        title={t("suggest.add")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <WriteForm study={study} onClose={dialog.close} />
      </Modal>
    </>
  );
}

const byVersion = (all: readonly Suggestion[]): [number, readonly Suggestion[]][] =>
  [...new Set(all.map((one) => one.version))].map((version) => [
    version,
    all.filter((one) => one.version === version),
  ]);

interface ItemProps {
  readonly one: Suggestion;
  readonly study: StudyDetail;
}

function Item({ one, study }: ItemProps): JSX.Element {
  const { t, language } = useTexts();
  const can = usePermissions();
  const status =
    one.adopted_in === null
      ? t(`suggestions.${one.status}`)
      : t("suggestions.adoptedIn", { version: one.adopted_in });
  return (
    <li className={`${classes.item} ${classes[one.status]}`}>
      <span className={classes.status}>
        <Icon name={SIGNS[one.status]} size={16} />
        {status}
      </span>
      <div>
        <div className={classes.about}>{one.about_title ?? t("suggestions.whole")}</div>
        <p className={classes.body}>{one.body}</p>
        <div className={classes.author}>
          {t("suggestions.by", {
            who: one.by.replace("account:", ""),
            when: dateTime(one.at, language),
          })}
          {one.session_id !== null && (
            <>
              {" · "}
              <Link href={`/sessions/${one.session_id}`}>
                {t("suggestions.fromSession", { code: one.participant_code ?? "" })}
              </Link>
            </>
          )}
        </div>
      </div>
      {one.status === "open" && can("design") && <Decide one={one} study={study} />}
    </li>
  );
}

const SIGNS = { open: "clock", adopted: "check", declined: "close" } as const;

function Decide({ one, study }: ItemProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const decide = useMutation({
    mutationFn: ([status, version]: ["adopted" | "declined", number | null]) =>
      suggestions.decide(one.id, status, version),
    onSettled: () => void queries.invalidateQueries(suggestionsQuery(study.key)),
  });
  const later = study.versions.map(({ number }) => number).filter((n) => n > one.version);
  return (
    <div>
      <Group gap="xs" wrap="nowrap">
        <Menu position="bottom-end" withInitialFocusPlaceholder={false}>
          <Menu.Target>
            <Button size="xs" variant="default" rightSection={<Icon name="down" size={14} />}>
              {t("suggestions.adopt")}
            </Button>
          </Menu.Target>
          <Menu.Dropdown>
            <Menu.Label>{t("suggestions.adoptIn")}</Menu.Label>
            {later.map((version) => (
              <Menu.Item key={version} onClick={() => decide.mutate(["adopted", version])}>
                {t("suggestions.version", { version })}
              </Menu.Item>
            ))}
            <Menu.Item onClick={() => decide.mutate(["adopted", null])}>
              {t("suggestions.later")}
            </Menu.Item>
          </Menu.Dropdown>
        </Menu>
        <Button
          size="xs"
          variant="default"
          loading={decide.isPending}
          onClick={() => decide.mutate(["declined", null])}
        >
          {t("suggestions.decline")}
        </Button>
      </Group>
      {decide.isError && <Failure error={decide.error} />}
    </div>
  );
}

interface WriteFormProps {
  readonly study: StudyDetail;
  readonly onClose: () => void;
}

function WriteForm({ study, onClose }: WriteFormProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [body, setBody] = useState("");
  const [version, setVersion] = useState(study.version);
  const add = useMutation({
    mutationFn: () => suggestions.add(study.key, { version, about: "", body: body.trim() }),
    onSuccess: () => {
      void queries.invalidateQueries(suggestionsQuery(study.key));
      onClose();
    },
  });
  const submit = useSingleSubmit(add);
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (body.trim() !== "") submit();
      }}
    >
      <Stack>
        <Textarea
          label={t("suggest.write")}
          data-autofocus
          autosize
          minRows={3}
          maxLength={4000}
          value={body}
          onChange={(event) => setBody(event.currentTarget.value)}
        />
        <NativeSelect
          label={t("suggest.about")}
          data={study.versions.map(({ number }) => ({
            value: String(number),
            label: t("suggestions.version", { version: number }),
          }))}
          value={String(version)}
          onChange={(event) => setVersion(Number(event.currentTarget.value))}
        />
        {add.isError && <Failure error={add.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" disabled={body.trim() === ""} loading={add.isPending}>
            {t("suggest.save")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
