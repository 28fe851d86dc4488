import { localStorageColorSchemeManager } from "@mantine/core";

/** Set the colour scheme as Mantine's provider will, before it is there. */
export function applyColorScheme(): void {
  const chosen = localStorageColorSchemeManager().get("auto");
  const isDark =
    chosen === "dark" ||
    (chosen === "auto" && window.matchMedia("(prefers-color-scheme: dark)").matches);
  document.documentElement.dataset.mantineColorScheme = isDark ? "dark" : "light";
}
