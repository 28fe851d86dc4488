/**
 * What is drawn, kept in the page's address: whoever is sent it sees the same.
 *
 * It stands before the `#` of the page's place, and is taken out when the page is left.
 */
import { type Asked, askedOf, searchOf } from "@shared/api/analysis";
import { useEffect } from "react";
import { useLocation, useSearch } from "wouter";

export function useAsked(): readonly [Asked, (next: Asked) => void] {
  const [place, navigate] = useLocation();
  const search = useSearch();
  useEffect(() => {
    const own = window.location.hash;
    return () => {
      const { hash, pathname, search: left } = window.location;
      if (hash !== own && left !== "") history.replaceState(null, "", pathname + hash);
    };
  }, []);
  // In place: going back leaves the page, not the last choice of a filter.
  const ask = (next: Asked): void => navigate(`${place}?${searchOf(next)}`, { replace: true });
  return [askedOf(new URLSearchParams(search)), ask];
}
