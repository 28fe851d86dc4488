import { existsSync, readdirSync } from "node:fs";
import type { ClientRequest, IncomingMessage } from "node:http";
import { resolve } from "node:path";
import react from "@vitejs/plugin-react";
import { defineConfig, type Plugin, type ProxyOptions } from "vite";
import { helpPages } from "./helpPages.ts";
import { tabletWorker, WORKER } from "./tabletWorker.ts";

const source = resolve(import.meta.dirname, "src");
/** The help pages are made of Markdown and pictures outside of `frontend`. */
const repository = resolve(import.meta.dirname, "..");

/** Every folder of `src` that holds an index.html is a page of its own: console, tablet, ... */
const pages = readdirSync(source).filter((name) => existsSync(resolve(source, name, "index.html")));

/** The server answers `/` with the console and `/tablet` with the tablet; so does the dev server. */
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

/** The server that `./run` starts; another one with REEMBODY_URL=http://HOST:PORT npm run dev. */
const SERVER = new URL(process.env.REEMBODY_URL ?? "http://127.0.0.1:8321");

/**
 * The server takes changes and sockets from its own pages only (app/api/guards.py). To pages of
 * the dev server it must look as if they were its own; to pages of anybody else it must not.
 */
const proxyToServer: ProxyOptions = {
  target: SERVER.origin,
  changeOrigin: true,
  ws: true,
  configure(proxy) {
    const sayOurs = (outgoing: ClientRequest, request: IncomingMessage) => {
      const { origin, host } = request.headers;
      if (origin === `http://${host}`) outgoing.setHeader("origin", SERVER.origin);
    };
    proxy.on("proxyReq", sayOurs);
    proxy.on("proxyReqWs", sayOurs);
  },
};

export default defineConfig({
  root: source,
  cacheDir: resolve(import.meta.dirname, "node_modules/.vite"),
  publicDir: false,
  plugins: [react(), servePagesLikeTheServer(), helpPages(repository), tabletWorker()],
  resolve: {
    alias: { "@shared": resolve(source, "shared"), "@charts": resolve(source, "charts") },
  },
  build: {
    outDir: resolve(import.meta.dirname, "../app/static"),
    emptyOutDir: true,
    manifest: true,
    // The content security policy allows scripts from 'self' only: nothing may be inlined.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1500,
    rolldownOptions: {
      input: {
        ...Object.fromEntries(pages.map((name) => [name, resolve(source, name, "index.html")])),
        [WORKER]: resolve(source, "tablet/offline/worker.ts"),
      },
      output: {
        // A service worker is known by its address.
        entryFileNames: ({ name }) => (name === WORKER ? "[name].js" : "assets/[name]-[hash].js"),
      },
    },
  },
  server: { port: 5173, fs: { allow: [repository] }, proxy: { "/api": proxyToServer } },
});
