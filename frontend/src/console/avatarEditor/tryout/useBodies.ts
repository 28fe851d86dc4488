/** Which bodies are tried: that of the working configuration, and a saved version beside it. */
import { useDebouncedValue } from "@mantine/hooks";
import { useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { useTexts } from "../../i18n";
import { type AvatarFile, bodyQuery, savedAvatarsQuery, savedVersionQuery } from "./source";

/** A configuration that is being typed is built when the typing pauses. */
const PAUSE_MS = 300;
const NEWEST_VERSIONS = 5;

/** The bodies of the working configuration and, beside it, of a saved version. */
export function useBodies(configuration: AvatarFile, other: string | null, statureM: number) {
  const [settled] = useDebouncedValue(configuration, PAUSE_MS);
  const [settledM] = useDebouncedValue(statureM, PAUSE_MS);
  const own = useQuery(bodyQuery(settled, settledM));
  const saved = useQuery(savedVersionQuery(other));
  const second = useQuery(
    bodyQuery(other === null ? null : (saved.data?.configuration ?? null), settledM),
  );
  const beside = other === null ? null : (second.data ?? null);
  const first = own.data ?? null;
  const data = useMemo(
    () => (first === null ? null : beside === null ? [first] : [first, beside]),
    [first, beside],
  );
  return { data, error: own.error ?? saved.error ?? second.error };
}

/** The newest versions of every saved avatar. */
export function useOthers() {
  const { t } = useTexts();
  const { data = [] } = useQuery(savedAvatarsQuery);
  return data.flatMap(({ key, title, newest }) =>
    Array.from({ length: Math.min(newest.number, NEWEST_VERSIONS) }, (_, back) => {
      const number = newest.number - back;
      return { value: `${key} ${number}`, label: t("tryout.compare.version", { title, number }) };
    }),
  );
}
