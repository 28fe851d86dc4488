/**
 * What every page starts with: theme, data cache, failed parts. The page imports its styles first.
 */
import { MantineProvider } from "@mantine/core";
import { QueryClient, QueryClientProvider } from "@tanstack/react-query";
import type { i18n } from "i18next";
import { type JSX, type ReactNode, StrictMode, useEffect } from "react";
import { flushSync } from "react-dom";
import { createRoot } from "react-dom/client";
import { I18nextProvider } from "react-i18next";
import { ApiError } from "../api/request";
import { theme } from "../theme/theme";
import { Boundary, UnloadedBar } from "./Boundary";
import { followImports } from "./unloaded";
import "../theme/tokens.css";
import "../theme/narrow.css";

const queries = new QueryClient({
  defaultOptions: {
    queries: {
      staleTime: 10_000,
      // The server's answer would be the same after a retry; only a lost connection is worth one.
      retry: (count, error) => !(error instanceof ApiError) && count < 2,
    },
  },
});

interface PageProps {
  readonly translations: i18n;
  /** Draw everything before `mountPage` returns, in the place of what is there. */
  readonly isAtOnce?: boolean;
  readonly children: ReactNode;
}

function Page({ translations, children }: PageProps): JSX.Element {
  useEffect(() => {
    const follow = (language: string) => {
      document.documentElement.lang = language;
    };
    follow(translations.language);
    translations.on("languageChanged", follow);
    return () => translations.off("languageChanged", follow);
  }, [translations]);
  return (
    <StrictMode>
      <MantineProvider theme={theme} defaultColorScheme="auto">
        <I18nextProvider i18n={translations}>
          <QueryClientProvider client={queries}>
            <Boundary>{children}</Boundary>
            <UnloadedBar />
          </QueryClientProvider>
        </I18nextProvider>
      </MantineProvider>
    </StrictMode>
  );
}

export function mountPage(page: PageProps): void {
  const root = document.getElementById("root");
  if (root === null) throw new Error("The page has no element #root to draw into.");
  followImports();
  const draw = () => createRoot(root).render(<Page {...page} />);
  if (page.isAtOnce) flushSync(draw);
  else draw();
}
