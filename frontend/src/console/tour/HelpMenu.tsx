/** The sidebar's help menu: help pages, scripted participant, and the tour where there is one. */
import { ActionIcon, Menu } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { studies } from "@shared/api/endpoints";
import type { StudySummary } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { describe } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { useErrorTexts } from "../errors";
import { lastStudy } from "../frame/currentStudy";
import { helpFor } from "../help/address";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { studiesQuery, studyQuery } from "../queries";
import { Key } from "../ui/Key";
import classes from "./HelpMenu.module.css";
import { opened as newTab, useActOnScreen } from "./onScreen";
import { studyToTry } from "./studyToTry";
import { studyLanguage, useStartTryout } from "./TryIt";
import { startTour } from "./tourStore";

export function HelpMenu(): JSX.Element {
  const { t, language } = useTexts();
  const [address] = useHashLocation();
  const [opened, setOpened] = useState(false);
  const errors = useErrorTexts();
  const queries = useQueryClient();
  const start = useStartTryout();
  const can = usePermissions();
  const act = useActOnScreen();
  const tries = can("tryout") || can("run");
  const listed = useQuery({ ...studiesQuery, enabled: opened && tries });
  const study = studyToTry(address, listed.data ?? [], lastStudy());
  const studyKey = study?.key ?? null;
  const tell = (error: unknown) => {
    const { message, remedy } = describe(error, errors);
    notifications.show({ color: "red", title: message, message: remedy, autoClose: 12_000 });
  };
  const begin = useMutation({
    mutationFn: async (key: string) => {
      const study = await queries.fetchQuery({
        ...studyQuery(key),
        queryFn: () => studies.get(key),
      });
      return start.mutateAsync({
        studyKey: key,
        language: studyLanguage(study.languages, language),
      });
    },
    onError: tell,
  });
  return (
    <Menu
      position="bottom-end"
      width={330}
      opened={opened}
      onChange={setOpened}
      withInitialFocusPlaceholder={false}
    >
      <Menu.Target>
        <ActionIcon
          variant="subtle"
          color="gray"
          size="lg"
          aria-label={t("help.title")}
          title={t("help.title")}
          loading={begin.isPending || act.isPending}
        >
          <Icon name="help" />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Item
          component={Link}
          href={helpFor(address)}
          leftSection={<Icon name="document" size={16} />}
          rightSection={<Key name="?" />}
        >
          {t("helpPages.menu")}
          <span className={classes.hint}>{t("helpPages.menu.hint")}</span>
        </Menu.Item>
        {can("tryout") && (
          <Menu.Item
            leftSection={<Icon name="play" size={16} />}
            disabled={studyKey === null}
            onClick={() => studyKey !== null && begin.mutate(studyKey)}
          >
            {t("help.try")}
            <StudyHint study={study} isKnown={listed.isSuccess} hint={t("help.try.hint")} />
          </Menu.Item>
        )}
        {can("run") && (
          <Menu.Item
            leftSection={<Icon name="headset" size={16} />}
            disabled={studyKey === null}
            onClick={() =>
              studyKey !== null && act.mutate({ studyKey, tab: newTab() }, { onError: tell })
            }
          >
            {t("help.act")}
            <StudyHint study={study} isKnown={listed.isSuccess} hint={t("help.act.hint")} />
          </Menu.Item>
        )}
        {can("tryout") && isSession(address) && (
          <Menu.Item leftSection={<Icon name="flag" size={16} />} onClick={startTour}>
            {t("help.tour")}
          </Menu.Item>
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

interface StudyHintProps {
  readonly study: StudySummary | null;
  readonly isKnown: boolean;
  readonly hint: string;
}

/** What an entry does, and with which study. */
function StudyHint({ study, isKnown, hint }: StudyHintProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <>
      <span className={classes.hint}>{study === null && isKnown ? t("help.noStudy") : hint}</span>
      {study !== null && (
        <span className={classes.hint}>
          {t("home.step.study", { title: inLanguage(study.titles, language) })}
        </span>
      )}
    </>
  );
}

const isSession = (address: string): boolean => /^\/sessions\/[^/]+$/.test(address);
