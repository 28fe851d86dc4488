/**
 * Build the tablet's page and its service worker after the other pages, into the same folder.
 *
 * A page that is built with the others shares some twenty small files with them, and the participant
 * waits until each was fetched. Built by itself it has two scripts, with nothing in them that the
 * tablet does not use: a small one that draws a form at once (`tablet/early`), and the application.
 */
import { resolve } from "node:path";
import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";
import { brotli } from "./brotli.ts";
import { TABLET_MANIFEST, tabletWorker, WORKER } from "./tabletWorker.ts";
import { usedStyles } from "./usedStyles.ts";
import { alias, output, source, TABLET } from "./vite.config.ts";

export default defineConfig({
  root: source,
  cacheDir: resolve(import.meta.dirname, "node_modules/.vite"),
  publicDir: false,
  plugins: [react(), usedStyles(resolve(source, TABLET, "mantine.css")), tabletWorker(), brotli()],
  resolve: { alias },
  build: {
    ...output,
    emptyOutDir: false,
    manifest: TABLET_MANIFEST,
    rolldownOptions: {
      input: {
        [TABLET]: resolve(source, TABLET, "index.html"),
        [WORKER]: resolve(source, TABLET, "offline/worker.ts"),
      },
      output: {
        // The browser identifies a service worker by its URL, so its name must not change.
        entryFileNames: ({ name }) => (name === WORKER ? "[name].js" : "assets/[name]-[hash].js"),
      },
    },
  },
});
