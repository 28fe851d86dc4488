/**
 * Every version of a study, the differences between any two, and archiving or deleting the study.
 */
import { Button, Group, Modal, NativeSelect, Stack, Text, TextInput } from "@mantine/core";
import { versions } from "@shared/api/drafts";
import type { StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link, useLocation } from "wouter";
import { DiffView } from "../../editor/DiffView";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { versionDiffQuery } from "../../queries";
import { Loaded } from "../../ui/Loaded";
import { ScrollBox } from "../../ui/tables";
import { useFormSubmit } from "../../ui/useSingleSubmit";
import page from "./StudyPage.module.css";
import classes from "./VersionsTab.module.css";

export function VersionsTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t, language } = useTexts();
  const can = usePermissions();
  return (
    <>
      <div className={page.toolbar}>
        <span className={classes.lead}>{t("versions.lead")}</span>
        {can("design") && (
          <div className={`${page.spacer} ${classes.actions}`}>
            <Button
              component={Link}
              href={`/studies/${study.key}/edit`}
              leftSection={<Icon name="document" size={17} />}
            >
              {t("versions.edit")}
            </Button>
            <Duplicate study={study} />
            {study.archived_at === null && <Archive study={study} />}
          </div>
        )}
      </div>
      <ScrollBox label={t("versions.tab")}>
        <table className={`${classes.table} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("versions.number")}</th>
              <th scope="col">{t("versions.made")}</th>
              <th scope="col">{t("versions.state")}</th>
              <th scope="col">sha256</th>
            </tr>
          </thead>
          <tbody>
            {[...study.versions].reverse().map((version) => (
              <tr key={version.number}>
                <th scope="row">{version.number}</th>
                <td>{dateTime(version.created_at, language)}</td>
                <td>
                  <Icon name={version.frozen_at === null ? "document" : "lock"} size={15} />{" "}
                  {t(version.frozen_at === null ? "study.open" : "study.frozen")}
                </td>
                <td className={classes.hash}>{version.content_hash}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </ScrollBox>
      <Compare study={study} />
    </>
  );
}

function Compare({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const numbers = study.versions.map(({ number }) => number);
  const [from, setFrom] = useState(Math.max(1, numbers.length - 1));
  const [to, setTo] = useState(numbers.length);
  const query = useQuery({
    ...versionDiffQuery(study.key, from, to),
    enabled: numbers.length > 1,
  });
  if (numbers.length < 2) return <p className={classes.lead}>{t("versions.one")}</p>;
  const data = numbers.map(String);
  return (
    <section aria-label={t("versions.compare")} className={classes.compare}>
      <Group align="end" mb="md">
        <NativeSelect
          label={t("versions.from")}
          data={data}
          value={String(from)}
          onChange={(event) => setFrom(Number(event.currentTarget.value))}
        />
        <NativeSelect
          label={t("versions.to")}
          data={data}
          value={String(to)}
          onChange={(event) => setTo(Number(event.currentTarget.value))}
        />
      </Group>
      <Loaded query={query}>{(diff) => <DiffView diff={diff} />}</Loaded>
    </section>
  );
}

function Duplicate({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  const [opened, setOpened] = useState(false);
  const [key, setKey] = useState(`${study.key}-copy`);
  const copy = useMutation({
    mutationFn: () => versions.duplicate(study.key, key.trim()),
    onSuccess: async (created) => {
      setOpened(false);
      await queries.invalidateQueries({ queryKey: ["studies"] });
      navigate(`/studies/${created.key}/edit`);
    },
  });
  const submit = useFormSubmit(copy, { isReused: true });
  const close = () => {
    copy.reset();
    setOpened(false);
  };
  return (
    <>
      <Button variant="default" onClick={() => setOpened(true)}>
        {t("versions.duplicate")}
      </Button>
      <Modal
        opened={opened}
        onClose={close}
        title={t("versions.duplicate")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <form onSubmit={submit}>
          <Stack>
            <TextInput
              data-autofocus
              label={t("versions.duplicate.key")}
              description={t("versions.duplicate.hint")}
              value={key}
              onChange={(event) => setKey(event.currentTarget.value)}
            />
            {copy.isError && <Failure error={copy.error} />}
            <Group justify="flex-end">
              <Button type="submit" loading={copy.isPending} disabled={key.trim() === ""}>
                {t("versions.duplicate")}
              </Button>
            </Group>
          </Stack>
        </form>
      </Modal>
    </>
  );
}

function Archive({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [opened, setOpened] = useState(false);
  const archive = useMutation({
    mutationFn: () => versions.archive(study.key),
    onSuccess: async () => {
      setOpened(false);
      await queries.invalidateQueries({ queryKey: ["studies"] });
    },
  });
  const close = () => {
    archive.reset();
    setOpened(false);
  };
  return (
    <>
      <Button variant="default" onClick={() => setOpened(true)}>
        {t("versions.archive")}
      </Button>
      <Modal
        opened={opened}
        onClose={close}
        title={t("versions.archive.title")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <Stack>
          <Text>{t("versions.archive.body")}</Text>
          {archive.isError && <Failure error={archive.error} />}
          <Group justify="flex-end">
            <Button variant="default" onClick={close}>
              {t("action.cancel")}
            </Button>
            <Button loading={archive.isPending} onClick={() => archive.mutate()}>
              {t("versions.archive")}
            </Button>
          </Group>
        </Stack>
      </Modal>
    </>
  );
}
