/** The demo lab: load it, see how far it is, remove it. */
import { DEMO_KEY, demo } from "@shared/api/housekeeping";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";
import { demoQuery } from "../queries";

/** How many simulated people a figure with an interval needs. */
export const ENOUGH = 2;
const FIGURES = `/studies/${DEMO_KEY}/dashboard`;

/** How far the demo lab is; what it changes is requested again as people come through. */
export function useDemo(enabled: boolean) {
  const queries = useQueryClient();
  const query = useQuery({ ...demoQuery, enabled });
  const through = query.data?.completed;
  useEffect(() => {
    if (through !== undefined && through > 0) {
      void queries.invalidateQueries({ queryKey: ["studies"] });
    }
  }, [through, queries]);
  return query.data ?? null;
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
