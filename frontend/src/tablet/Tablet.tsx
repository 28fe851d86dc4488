/** The participant's tablet: unpaired it asks for a code, paired it shows the session's screen. */
import { tablet } from "@shared/api/endpoints";
import { ApiError, isUnauthorised } from "@shared/api/errors";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useRef } from "react";
import { codeFromAddress } from "./code";
import { useTexts } from "./i18n";
import { Pairing } from "./screens/Pairing";

const STATE = ["tablet", "state"] as const;

export function Tablet(): JSX.Element {
  const queries = useQueryClient();
  const { t } = useTexts();
  const state = useQuery({ queryKey: STATE, queryFn: tablet.state });
  const pairing = useMutation({
    mutationFn: async (code: string) => {
      const paired = await tablet.pair(code);
      if (paired.device !== "tablet") {
        throw new ApiError(409, {
          code: "wrong_device",
          message: t("pair.headset"),
          remedy: t("pair.headsetRemedy"),
        });
      }
    },
    onSuccess: () => queries.invalidateQueries({ queryKey: STATE }),
  });
  useCodeOfAddress(pairing.mutate);

  if (state.data !== undefined && !state.isError) return <main>{state.data.screen}</main>;
  return (
    <Pairing
      ended={isUnauthorised(state.error) && state.data !== undefined}
      pending={pairing.isPending}
      error={pairing.error}
      onCode={pairing.mutate}
    />
  );
}

/** A QR link carries the code once: use it, and take it out of the address and the history. */
function useCodeOfAddress(pair: (code: string) => void): void {
  const used = useRef(false);
  useEffect(() => {
    if (used.current) return;
    used.current = true;
    const { code, rest } = codeFromAddress(new URL(window.location.href));
    if (code === null) return;
    window.history.replaceState(null, "", rest);
    pair(code);
  }, [pair]);
}
