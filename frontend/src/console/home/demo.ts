/** The demo lab: load it, see how far it is, remove it. */
import { DEMO_KEY, type Demo, demo } from "@shared/api/housekeeping";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { demoQuery } from "../queries";

export const FIGURES = `/studies/${DEMO_KEY}/dashboard`;

/** How far the demo lab is; null until it is known, and for people who may not load it. */
export function useDemo(): Demo | null {
  const can = usePermissions();
  return useQuery({ ...demoQuery, enabled: can("demo") }).data ?? null;
}

/** The same; and what it changes is requested again as people come through. */
export function useFollowedDemo(): Demo | null {
  const queries = useQueryClient();
  const found = useDemo();
  const through = found?.completed;
  useEffect(() => {
    if (through !== undefined && through > 0) {
      void queries.invalidateQueries({ queryKey: ["studies"] });
    }
  }, [through, queries]);
  return found;
}

/** Loads it and goes to its figures. */
export function useLoadDemo() {
  const { language } = useTexts();
  const queries = useQueryClient();
  const [, navigate] = useLocation();
  return useMutation({
    mutationFn: () => demo.load(language),
    onSuccess: async (view) => {
      queries.setQueryData(demoQuery.queryKey, view);
      await queries.invalidateQueries({ queryKey: ["studies"], exact: true });
      navigate(FIGURES);
    },
  });
}

export function useRemoveDemo() {
  const queries = useQueryClient();
  const [, navigate] = useLocation();
  return useMutation({
    mutationFn: demo.remove,
    onSuccess: async () => {
      navigate("/");
      queries.removeQueries({ queryKey: ["studies", DEMO_KEY] });
      await queries.invalidateQueries({ queryKey: ["demo"] });
      await queries.invalidateQueries({ queryKey: ["studies"] });
    },
  });
}
