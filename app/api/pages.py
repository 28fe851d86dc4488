"""Serving the built pages."""

from collections.abc import Callable
from pathlib import Path

from fastapi import APIRouter, FastAPI
from fastapi.responses import FileResponse, HTMLResponse, Response

from app.api.assets import Assets

PAGES = {"/": "console/index.html", "/tablet": "tablet/index.html"}
# A service worker may look after addresses beside and below its own, and is known by its address.
TABLET_WORKER = "/tablet-worker.js"
_NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Reembody</title>
<h1>The pages are not built yet</h1><p>The interface under /api works. Start the server with
<code>./run</code>, which builds the pages.</p></html>"""


def install_pages(app: FastAPI, static: Path) -> None:
    """Serve each page at its address and the hashed assets for ever."""
    router = APIRouter(include_in_schema=False)
    for address, file in PAGES.items():
        router.add_api_route(address, _page(static / file), methods=["GET"])
    worker = _worker(static / TABLET_WORKER[1:])
    router.add_api_route(TABLET_WORKER, worker, methods=["GET"])
    app.include_router(router)
    if (static / "assets").is_dir():
        app.mount("/assets", Assets(directory=static / "assets"), name="assets")


def _page(file: Path) -> Callable[[], Response]:
    def serve() -> Response:
        if not file.is_file():
            return HTMLResponse(_NOT_BUILT, status_code=503)
        return FileResponse(file, headers={"cache-control": "no-cache"})

    return serve


def _worker(file: Path) -> Callable[[], Response]:
    def serve() -> Response:
        if not file.is_file():
            return Response(status_code=404)
        # Asked for at every start of the tablet's page, so that a new build is noticed at once.
        headers = {"cache-control": "no-cache"}
        return FileResponse(file, headers=headers, media_type="text/javascript")

    return serve
