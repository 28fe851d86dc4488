/** Always there: one press calls the experimenter, and the bar says that the call has arrived. */
import { Button } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import type { TabletState } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { STATE_KEY } from "../useTabletState";
import classes from "./CallForHelp.module.css";

interface CallForHelpProps {
  readonly state: TabletState;
  readonly connected: boolean;
}

export function CallForHelp({ state, connected }: CallForHelpProps): JSX.Element | null {
  const { t } = useTexts();
  const queries = useQueryClient();
  const call = useMutation({
    mutationFn: tablet.help,
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  if (state.screen === "finished") return null;
  return (
    <div className={classes.help}>
      <span className={classes.said} role="status">
        {state.help_asked ? t("help.called") : call.isError || !connected ? t("help.failed") : ""}
      </span>
      {connected && (
        <Button
          size="sm"
          variant={state.help_asked ? "subtle" : "default"}
          color="gray"
          loading={call.isPending}
          leftSection={<Icon name={state.help_asked ? "close" : "help"} size={18} />}
          onClick={() => call.mutate(!state.help_asked)}
        >
          {t(state.help_asked ? "help.takeBack" : "help.call")}
        </Button>
      )}
    </div>
  );
}
