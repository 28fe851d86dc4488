/** Whether the camera goes along with the body: by itself only for those who like moving pictures. */
import { useReducedMotion } from "@mantine/hooks";
import { useEffect, useState } from "react";
import type { TryoutScene } from "./scene";

export interface Follow {
  readonly isOn: boolean;
  readonly toggle: () => void;
}

export function useFollow(scene: TryoutScene | null): Follow {
  const isStill = useReducedMotion(undefined, { getInitialValueInEffect: false });
  const [chosen, setChosen] = useState<boolean | null>(null);
  const isOn = chosen ?? !isStill;
  useEffect(() => scene?.setFollowing(isOn), [scene, isOn]);
  return { isOn, toggle: () => setChosen(!isOn) };
}
