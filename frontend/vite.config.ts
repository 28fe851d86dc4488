import { existsSync, readdirSync } from "node:fs";
import type { ClientRequest, IncomingMessage } from "node:http";
import { resolve } from "node:path";
import react from "@vitejs/plugin-react";
import { defineConfig, type Plugin, type ProxyOptions } from "vite";
import { brotli } from "./brotli.ts";
import { helpPages } from "./helpPages.ts";
import { textTables } from "./textTables.ts";
import { usedStyles } from "./usedStyles.ts";

export const source = resolve(import.meta.dirname, "src");
/** The help pages are made from Markdown and pictures outside of `frontend`. */
const repository = resolve(import.meta.dirname, "..");

export const alias = { "@shared": resolve(source, "shared"), "@charts": resolve(source, "charts") };

/** The tablet's page, which is built by itself: see vite.tablet.config.ts. */
export const TABLET = "tablet";

/** Every folder of `src` with an index.html is a page of its own: console, tablet, ... */
const pages = readdirSync(source).filter((name) => existsSync(resolve(source, name, "index.html")));

export const output = {
  outDir: resolve(import.meta.dirname, "../app/static"),
  // The content security policy allows scripts from 'self' only: nothing may be inlined.
  assetsInlineLimit: 0,
  modulePreload: { polyfill: false },
  chunkSizeWarningLimit: 1500,
} as const;

/** Workers that run WebAssembly: the server gives their folder a policy that allows it. */
const WASM = new Set([
  "codeWorker",
  "meshoptWorker",
  "textureWorker",
  "bodiesWorker",
  "tryoutWorker",
]);

/** Serve the console at `/` and the tablet at `/tablet`, as the server does. */
function servePagesLikeTheServer(): Plugin {
  return {
    name: "serve-pages-like-the-server",
    configureServer(server) {
      server.middlewares.use((request, _response, next) => {
        const [path, query] = (request.url ?? "/").split("?");
        const page = path === "/" ? "console" : pages.find((name) => path === `/${name}`);
        if (page !== undefined) request.url = `/${page}/index.html${query ? `?${query}` : ""}`;
        next();
      });
    },
  };
}

/** The server that `./run` starts; use another with REEMBODY_URL=http://HOST:PORT npm run dev. */
const SERVER = new URL(process.env.REEMBODY_URL ?? "http://127.0.0.1:8321");

/**
 * The server accepts changes and sockets from its own pages only (app/api/guards.py). Requests from
 * pages of the dev server must look like its own; requests from any other page must not.
 */
const proxyToServer: ProxyOptions = {
  target: SERVER.origin,
  changeOrigin: true,
  ws: true,
  configure(proxy) {
    const rewriteOrigin = (outgoing: ClientRequest, request: IncomingMessage) => {
      const { origin, host } = request.headers;
      if (origin === `http://${host}`) outgoing.setHeader("origin", SERVER.origin);
    };
    proxy.on("proxyReq", rewriteOrigin);
    proxy.on("proxyReqWs", rewriteOrigin);
  },
};

export default defineConfig({
  root: source,
  cacheDir: resolve(import.meta.dirname, "node_modules/.vite"),
  publicDir: false,
  plugins: [
    react(),
    servePagesLikeTheServer(),
    helpPages(repository),
    textTables(source, alias),
    usedStyles(resolve(source, "shared/theme/mantine.css")),
    brotli(),
  ],
  resolve: { alias },
  build: {
    ...output,
    emptyOutDir: true,
    rolldownOptions: {
      input: {
        ...Object.fromEntries(
          pages
            .filter((name) => name !== TABLET)
            .map((name) => [name, resolve(source, name, "index.html")]),
        ),
      },
    },
  },
  worker: {
    rolldownOptions: {
      output: {
        entryFileNames: ({ name }) => `assets/${WASM.has(name) ? "wasm/" : ""}[name]-[hash].js`,
      },
    },
  },
  server: { port: 5173, fs: { allow: [repository] }, proxy: { "/api": proxyToServer } },
});
