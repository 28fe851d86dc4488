/** In the header: the scripted participant, and the tour where there is something to show. */
import { ActionIcon, Menu } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { studies } from "@shared/api/endpoints";
import { describe } from "@shared/ui/ErrorNotice";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useHashLocation } from "wouter/use-hash-location";
import { useErrorTexts } from "../errors";
import { useTexts } from "../i18n";
import { studiesQuery, studyQuery } from "../queries";
import { choose } from "./choose";
import classes from "./HelpMenu.module.css";
import { spoken } from "./TryIt";
import { startTour } from "./tourStore";
import { useStartTryout } from "./useTryout";

export function HelpMenu(): JSX.Element {
  const { t, language } = useTexts();
  const [address] = useHashLocation();
  const [opened, setOpened] = useState(false);
  const errors = useErrorTexts();
  const queries = useQueryClient();
  const start = useStartTryout();
  const known = useQuery({ ...studiesQuery, enabled: opened });
  const studyKey = choose(address, known.data?.map(({ key }) => key) ?? []);
  const begin = useMutation({
    mutationFn: async (key: string) => {
      const study = await queries.fetchQuery({
        ...studyQuery(key),
        queryFn: () => studies.get(key),
      });
      return start.mutateAsync({ studyKey: key, language: spoken(study.languages, language) });
    },
    onError: (error) => {
      const { message, remedy } = describe(error, errors);
      notifications.show({ color: "red", title: message, message: remedy, autoClose: 12_000 });
    },
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
          loading={begin.isPending}
        >
          <Icon name="help" />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Item
          leftSection={<Icon name="play" size={16} />}
          disabled={studyKey === null}
          onClick={() => studyKey !== null && begin.mutate(studyKey)}
        >
          {t("help.try")}
          <span className={classes.hint}>
            {studyKey === null && known.isSuccess ? t("help.noStudy") : t("help.try.hint")}
          </span>
        </Menu.Item>
        {isSession(address) && (
          <Menu.Item leftSection={<Icon name="flag" size={16} />} onClick={startTour}>
            {t("help.tour")}
          </Menu.Item>
        )}
      </Menu.Dropdown>
    </Menu>
  );
}

const isSession = (address: string): boolean => /^\/sessions\/[^/]+$/.test(address);
