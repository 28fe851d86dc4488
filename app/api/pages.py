"""Serving the built pages."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from fastapi import APIRouter, FastAPI
from fastapi.responses import FileResponse, HTMLResponse, Response
from fastapi.staticfiles import StaticFiles

PAGES = {"/": "console/index.html", "/tablet": "tablet/index.html"}
_NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Reembody</title>
<h1>The pages are not built yet</h1><p>The interface under /api works. Start the server with
<code>./run</code>, which builds the pages.</p></html>"""


def install_pages(app: FastAPI, static: Path) -> None:
    """Serve each page at its address and the hashed assets for ever."""
    router = APIRouter(include_in_schema=False)
    for address, file in PAGES.items():
        router.add_api_route(address, _page(static / file), methods=["GET"])
    app.include_router(router)
    if (static / "assets").is_dir():
        app.mount("/assets", _Assets(directory=static / "assets"), name="assets")


def _page(file: Path) -> Callable[[], Response]:
    def serve() -> Response:
        if not file.is_file():
            return HTMLResponse(_NOT_BUILT, status_code=503)
        return FileResponse(file, headers={"cache-control": "no-cache"})

    return serve


class _Assets(StaticFiles):
    """File names carry a hash of the content, so a browser may keep them."""

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        response = super().file_response(*args, **kwargs)
        response.headers["cache-control"] = "public, max-age=31536000, immutable"
        return response
