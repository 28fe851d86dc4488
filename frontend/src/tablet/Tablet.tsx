/** The participant's tablet: it asks for a pairing code or shows the session's screen. */
import { Center, Loader } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import { ApiError, isUnauthorised } from "@shared/api/request";
import { codeFromAddress } from "@shared/pairingCode";
import { useMutation } from "@tanstack/react-query";
import { type JSX, useEffect, useRef } from "react";
import { Failure } from "./errors";
import { useTexts } from "./i18n";
import { pairedBefore, rememberPaired } from "./pairing";
import { Screens } from "./Screens";
import { Pairing } from "./screens/Pairing";
import { useTabletState } from "./useTabletState";

export function Tablet(): JSX.Element {
  const state = useTabletState();
  const pairing = usePairing(() => void state.query.refetch());
  useCodeOfAddress(pairing.mutate);
  const { data, error, isPending } = state.query;
  // The sixth character sends the code, and so does Enter: the second request of a code that has
  // just been used would be refused.
  const pair = (code: string) => {
    const isSent = pairing.isPending || (pairing.isSuccess && pairing.variables === code);
    if (!isSent) pairing.mutate(code);
  };

  if (isUnauthorised(error) || pairing.isPending || pairing.isError) {
    return (
      <Pairing
        ended={pairedBefore()}
        pending={pairing.isPending}
        error={pairing.error}
        onCode={pair}
      />
    );
  }
  if (data !== undefined) {
    return (
      <Screens
        state={data}
        connected={state.connected}
        show={state.show}
        refresh={() => void state.query.refetch()}
      />
    );
  }
  return (
    <Center mih="100dvh" p="xl">
      {isPending ? (
        <Loader />
      ) : (
        <Failure error={error} onRetry={() => void state.query.refetch()} />
      )}
    </Center>
  );
}

function usePairing(onPaired: () => void) {
  const { t } = useTexts();
  return useMutation({
    mutationFn: async (code: string) => {
      const paired = await tablet.pair(code);
      if (paired.device === "tablet") return rememberPaired();
      throw new ApiError(409, {
        code: "wrong_device",
        message: t("pair.headset"),
        remedy: t("pair.headsetRemedy"),
      });
    },
    onSuccess: onPaired,
  });
}

/** Use the pairing code of a QR link once, and remove it from the address and the history. */
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
