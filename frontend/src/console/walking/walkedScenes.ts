/** In which scenes walks took place, and how many in each. */
import type { Scene } from "@shared/api/walking";
import { number } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { useTexts } from "../i18n";
import { scenesQuery } from "./queries";

/** What names the floor without obstacles, as in tables of tracks. */
export const OPEN_FLOOR = "open floor";

const NEAR_M = -2;
const FEWEST_M = 5;

/** The open floor as a scene, so large that a model's longest path has room on it. */
export function openFloor(title: string, longest_m: number): Scene {
  const far = Math.max(FEWEST_M, Math.ceil(longest_m) + 1);
  return {
    key: OPEN_FLOOR,
    title,
    shipped: true,
    by: null,
    at: null,
    about: "",
    content_hash: "",
    bounds_m: [-far / 2, NEAR_M, far / 2, far],
    clearance_m: 0,
    obstacles: [],
    places: {},
    paths: [],
  };
}

export interface WalksInScene {
  /** Null for walks that name no scene: a model's own, or the open floor, is theirs. */
  readonly key: string | null;
  /** What a model remembers of it; else the present title is shown. */
  readonly title?: string;
  readonly walks: number;
}

/** A model's walks by scene, with those that name none in the model's. */
export function inModelsScene(
  scenes: readonly WalksInScene[],
  scene: { readonly key: string; readonly title: string } | null,
): readonly WalksInScene[] {
  const found = new Map<string, WalksInScene>();
  for (const one of scenes) {
    const { key, title } =
      one.key === null ? (scene ?? { key: OPEN_FLOOR, title: OPEN_FLOOR }) : one;
    if (key === null) continue;
    const walks = one.walks + (found.get(key)?.walks ?? 0);
    found.set(key, title === undefined ? { key, walks } : { key, title, walks });
  }
  return [...found.values()];
}

/** Say it in one line, such as `6 in Hall, 3 on the open floor`; those that name none come last. */
export function useWalkedScenes(): (scenes: readonly WalksInScene[]) => string {
  const { t, language } = useTexts();
  const known = useQuery(scenesQuery).data;
  const titleOf = (key: string): string => {
    const listed = known?.find((one) => one.key === key)?.title;
    return listed ?? (known === undefined ? key : t("walking.scenes.deleted", { key }));
  };
  const said = ({ key, title, walks }: WalksInScene): string => {
    const count = number(walks, language);
    if (key === null) return t("walking.scenes.ofModel", { count });
    if (key === OPEN_FLOOR) return t("walking.scenes.open", { count });
    return t("walking.scenes.in", { count, scene: title ?? titleOf(key) });
  };
  return (scenes) =>
    [...scenes.filter(({ key }) => key !== null), ...scenes.filter(({ key }) => key === null)]
      .map(said)
      .join(", ");
}
