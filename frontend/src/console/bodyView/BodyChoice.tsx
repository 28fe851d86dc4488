/** The choice of the body that an avatar of a capture wears, remembered by the browser. */
import { Select } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import type { BodyListed } from "@shared/api/bodies";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { titleOf } from "../bodies/names";
import { bodiesQuery } from "../bodies/queries";
import { useTexts } from "../i18n";

const SKELETON = "skeleton";
/** The body that is worn before anybody has chosen one. */
const USUAL = "neutral";

export interface BodyChoice {
  readonly bodies: readonly BodyListed[];
  /** The hash of the chosen body; null for the stick figure. */
  readonly hash: string | null;
  readonly choose: (hash: string | null) => void;
}

/** Without any body in the lab, movement is drawn as a stick figure. */
export function useBodyChoice(isWanted: boolean): BodyChoice {
  const { data: page } = useQuery({ ...bodiesQuery, enabled: isWanted });
  const data = page?.humanoids ?? [];
  const [chosen, setChosen] = useLocalStorage<string | null>({
    key: "reembody.captures.body",
    defaultValue: null,
  });
  const usual = data.find(({ name }) => name === USUAL) ?? data[0];
  const known = data.find(({ content_hash }) => content_hash === chosen) ?? usual;
  const hash = chosen === SKELETON ? null : (known?.content_hash ?? null);
  return { bodies: data, hash, choose: (one) => setChosen(one ?? SKELETON) };
}

export function BodySelect({ choice }: { readonly choice: BodyChoice }): JSX.Element | null {
  const { t } = useTexts();
  if (choice.bodies.length === 0) return null;
  return (
    <Select
      size="xs"
      w={180}
      aria-label={t("bodyView.drawn")}
      allowDeselect={false}
      value={choice.hash ?? SKELETON}
      onChange={(value) => choice.choose(value === SKELETON ? null : value)}
      data={[
        ...choice.bodies.map((body) => ({ value: body.content_hash, label: titleOf(body) })),
        { value: SKELETON, label: t("bodyView.drawn.skeleton") },
      ]}
    />
  );
}
