"""Bundle a frontend module for one test and load it under the server's own origin.

The product ships no test pages. A module that only a test needs is bundled by the frontend's own
Vite into a temporary folder, and the test answers the browser's requests for it: so it runs under
the server's origin and content security policy, as the product's pages do.
"""

import json
import mimetypes
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import BrowserContext, Page, Route

from app.api.guards import SECURITY_HEADERS
from app.api.pages import asset_headers
from tests.support.node import install_packages, run_node

FRONTEND = Path(__file__).resolve().parents[2] / "frontend"
BASE, SCRIPT = "/only-in-tests/", "page.js"
DOCUMENT = "/api/health"
"""A response of the server that runs no script."""
SIMULATING = ("bodiesWorker-", "tryoutWorker-")
# Run in the frontend's folder, so that its packages are found.
BUILD = """
import { build } from "vite";
import { textTables } from "./textTables.ts";
const source = process.cwd() + "/src";
const alias = { "@shared": source + "/shared", "@charts": source + "/charts" };
const [entry, outDir, base, entryFileNames, format] = JSON.parse(process.argv[1]);
await build({
  configFile: false, root: "src", base, logLevel: "warn", publicDir: false,
  resolve: { alias }, plugins: [textTables(source, alias)],
  worker: { format: "es" },
  build: {
    outDir, emptyOutDir: false, modulePreload: false, assetsInlineLimit: 0,
    rolldownOptions: { input: entry, output: { entryFileNames, format } },
  },
});
"""


@dataclass(frozen=True)
class Bundle:
    """A frontend module that was bundled into `folder`."""

    folder: Path

    def open(self, context: BrowserContext, server_url: str, document: str = DOCUMENT) -> Page:
        """Return a page that has run the module in a document of the server, with its policy."""
        # What a test answers comes from nowhere, in Chromium's eyes: a worker from there may reach
        # this machine only if it is allowed to.
        context.grant_permissions(["local-network-access"], origin=server_url)
        context.route(f"{server_url}{BASE}**", lambda route: self._answer(route))
        page = context.new_page()
        page.goto(server_url + document)
        for style in sorted(self.folder.rglob("*.css")):
            page.add_style_tag(url=BASE + style.relative_to(self.folder).as_posix())
        page.evaluate("(address) => import(address)", f"{BASE}{SCRIPT}")
        return page

    def _answer(self, route: Route) -> None:
        name = route.request.url.partition(BASE)[2]
        kind = mimetypes.guess_type(name)[0] or "application/octet-stream"
        body = (self.folder / name).read_bytes()
        # Workers that simulate have a policy of their own, which follows from their names.
        asset = name.removeprefix("assets/")
        path = f"wasm/{asset}" if asset.startswith(SIMULATING) else asset
        headers = {**SECURITY_HEADERS, **asset_headers(path)}
        route.fulfill(body=body, content_type=kind, headers=headers)


def bundled(entry: str, folder: Path) -> Bundle:
    """Bundle the module at `entry`, a path below `frontend/src`, into `folder`."""
    _build(entry, folder, "es")
    return Bundle(folder)


def bundled_script(entry: str, folder: Path) -> Path:
    """Bundle the module at `entry`, a path below `frontend/src`, into one classic script.

    Such a script can be injected into a page before the page's own.
    """
    _build(entry, folder, "iife")
    return folder / SCRIPT


def _build(entry: str, folder: Path, module_format: str) -> None:
    install_packages(FRONTEND)
    source = str(FRONTEND / "src" / entry)
    arguments = json.dumps([source, str(folder), BASE, SCRIPT, module_format])
    run_node("--input-type=module", "-e", BUILD, arguments, cwd=FRONTEND)
