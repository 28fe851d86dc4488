"""Serve the built pages, with compressed scripts and styles that browsers cache indefinitely.

Tablets and headsets fetch them over the lab's wireless network, where a megabyte takes a while.
"""

import asyncio
import gzip
import logging
import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from fastapi import APIRouter, FastAPI, Request
from fastapi.responses import FileResponse, HTMLResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.datastructures import Headers
from starlette.types import Scope

from app.errors import ReembodyError

log = logging.getLogger(__name__)
FirstAnswer = Callable[[Request], str | None]
"""Returns, as JSON, the answer to the first request that a page would send; None to let it ask."""
# Pictures and fonts are already compressed, and a small file gains nothing.
_WORTH_IT = (
    "text/javascript",
    "text/css",
    "image/svg+xml",
    "application/json",
    "application/wasm",
)
_SMALL_BYTES = 1024
_LEVEL = 6
_BROTLI = ".br"
TABLET = "/tablet"
PAGES = {"/": "console/index.html", TABLET: "tablet/index.html", "/vr": "vr/index.html"}
# A service worker controls the addresses next to and below its own, which identifies it.
TABLET_WORKER = "/tablet-worker.js"
# Workers that decode compressed models with WebAssembly. A worker has the policy of its own file,
# so pages need no permission to run WebAssembly. These workers may fetch nothing from anywhere.
WASM_WORKERS = "wasm/"
WASM_POLICY = "default-src 'none'; script-src 'self' blob: 'wasm-unsafe-eval'"
# The transcoder of KTX2 textures (Basis Universal) and MuJoCo's bindings also make functions from
# text when they start. Their workers alone may do so; no page may.
WORKERS_THAT_EVALUATE = ("wasm/textureWorker-", "wasm/bodiesWorker-", "wasm/tryoutWorker-")
# In an isolated page, the headset shares memory with the worker that simulates the bodies. All that
# such a page loads comes from this server, and its workers must be sent with the same policy.
ISOLATED = {"/vr"}
ISOLATION: Mapping[str, str] = MappingProxyType({"cross-origin-embedder-policy": "require-corp"})
# A page that is cut off from the page which opened it needs a new process of the browser, for which
# a participant would wait some 35 ms longer. One that the person opened by its address, a bookmark
# or a QR code has nothing to be cut off from: no other page has a handle of its window.
OPENED_BY_PERSON = ("sec-fetch-site", "none")
NOTHING_TO_CUT_OFF: Mapping[str, str] = MappingProxyType(
    {"cross-origin-opener-policy": "unsafe-none"}
)
FIRST_ANSWER = "first-answer"
# A page that has the answer already needs no request for it.
_PRELOADED = re.compile(r"<link[^>]* rel=\"preload\" as=\"fetch\"[^>]*>")
_NOT_BUILT = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Reembody</title>
<h1>The pages are not built yet</h1><p>The interface under /api works. Start the server with
<code>./run</code>, which builds the pages.</p></html>"""


class Assets(StaticFiles):
    """The static files whose names contain a hash of the content, so that browsers may cache them.

    The build has compressed them with Brotli, which browsers take by https and from their own
    machine (`frontend/brotli.ts`). For others a file is compressed with gzip once. Both stay in
    memory: about a megabyte for all pages together, and 2.6 for MuJoCo's WebAssembly.
    """

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        """Return a file with headers that let browsers cache it indefinitely."""
        response = super().file_response(*args, **kwargs)
        response.headers["cache-control"] = "public, max-age=31536000, immutable"
        return response

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return the file, compressed if the client accepts it."""
        response = await super().get_response(path, scope)
        policy = asset_headers(path)
        response.headers.update(policy)
        if not isinstance(response, FileResponse) or not _is_worth_it(response):
            return response
        response.headers["vary"] = "Accept-Encoding"
        taken = _encodings(Headers(scope=scope)) if scope["method"] == "GET" else frozenset()
        path = str(response.path)
        headers = {
            "cache-control": response.headers["cache-control"],
            "vary": "Accept-Encoding",
            **policy,
        }
        if "br" in taken and (body := await asyncio.to_thread(_prepared, path)) is not None:
            headers["content-encoding"] = "br"
            return Response(body, headers=headers, media_type=response.media_type)
        if "gzip" not in taken:
            return response
        headers["content-encoding"] = "gzip"
        body = await asyncio.to_thread(_compressed, path)
        return Response(body, headers=headers, media_type=response.media_type)


def asset_headers(path: str) -> Mapping[str, str]:
    """Return the headers of a file: those of workers in isolated pages, and of WebAssembly's."""
    path = path.replace("\\", "/")  # Starlette gives paths with the system's separators.
    if not path.startswith(WASM_WORKERS):
        return ISOLATION
    more = " 'unsafe-eval'" if path.startswith(WORKERS_THAT_EVALUATE) else ""
    return {**ISOLATION, "content-security-policy": WASM_POLICY + more}


def _is_worth_it(response: FileResponse) -> bool:
    kind = (response.media_type or "").partition(";")[0]
    size = int(response.headers.get("content-length", "0"))
    return response.status_code == 200 and kind in _WORTH_IT and size > _SMALL_BYTES


def _encodings(headers: Headers) -> frozenset[str]:
    """Return the encodings that a client takes by name."""
    offered = headers.get("accept-encoding", "").lower().replace(" ", "").split(",")
    named = (one.partition(";") for one in offered)
    return frozenset(name for name, _, weight in named if weight != "q=0")


@lru_cache(maxsize=1024)
def _prepared(path: str) -> bytes | None:
    """Return what the build has compressed, if it has; a file's name changes with its content."""
    prepared = Path(path + _BROTLI)
    return prepared.read_bytes() if prepared.is_file() else None


@lru_cache(maxsize=256)
def _compressed(path: str) -> bytes:
    """Return the compressed file, without a timestamp: the same bytes for the same content."""
    return gzip.compress(Path(path).read_bytes(), _LEVEL, mtime=0)


def install_pages(
    app: FastAPI, static: Path, first_answers: Mapping[str, FirstAnswer] = MappingProxyType({})
) -> None:
    """Serve each page at its address, and the assets under their hashed names.

    `first_answers`: by the address of a page, what is written into it, which saves it a request
    before it can show anything.
    """
    router = APIRouter(include_in_schema=False)
    for address, file in PAGES.items():
        page = _page(static / file, address, first_answers.get(address))
        # People also type it with a slash at its end: being sent on would take them a round trip.
        for path in {address, f"{address.rstrip('/')}/"}:
            router.add_api_route(path, page, methods=["GET", "HEAD"])
    worker = _worker(static / TABLET_WORKER[1:])
    router.add_api_route(TABLET_WORKER, worker, methods=["GET", "HEAD"])
    app.include_router(router)
    if (static / "assets").is_dir():
        app.mount("/assets", Assets(directory=static / "assets"), name="assets")


def _page(file: Path, address: str, first: FirstAnswer | None) -> Callable[[Request], Response]:
    def serve(request: Request) -> Response:
        if not file.is_file():
            return HTMLResponse(_NOT_BUILT, status_code=503)
        more_headers = _page_headers(address, request.headers)
        answer = None if first is None else _answer_if_possible(first, request)
        if answer is None:
            return FileResponse(file, headers={"cache-control": "no-cache", **more_headers})
        # It is a participant's: no cache may keep it.
        html = _with_answer(file.read_text(encoding="utf-8"), answer)
        return HTMLResponse(html, headers={"cache-control": "no-store", **more_headers})

    return serve


def _page_headers(address: str, request: Headers) -> dict[str, str]:
    if address in ISOLATED:
        return dict(ISOLATION)
    if address != TABLET:
        return {}
    name, value = OPENED_BY_PERSON
    is_opened_by_person = request.get(name) == value
    return {"vary": name, **(NOTHING_TO_CUT_OFF if is_opened_by_person else {})}


def _answer_if_possible(first: FirstAnswer, request: Request) -> str | None:
    """Return the answer; if it fails, the page opens without it, asks, and shows what is wrong."""
    try:
        return first(request)
    except ReembodyError:
        # A refusal, such as for an erased session: the page's own request gets it, too.
        return None
    except Exception as error:  # noqa: BLE001 - the page's own request reports it
        # Without a traceback, which must not fill a full disk.
        log.warning("a page is sent without its first answer: %s", error)
        return None


def _with_answer(html: str, answer: str) -> str:
    """Return a page with an answer written into it as JSON, which nothing in it can end."""
    data = answer.replace("<", "\\u003c")
    element = f'<script type="application/json" id="{FIRST_ANSWER}">{data}</script>'
    return _PRELOADED.sub("", html).replace("</head>", f"{element}</head>", 1)


def _worker(file: Path) -> Callable[[], Response]:
    def serve() -> Response:
        if not file.is_file():
            return Response(status_code=404)
        # Revalidated at every start of the tablet's page, so that a new build is noticed
        # immediately.
        headers = {"cache-control": "no-cache"}
        return FileResponse(file, headers=headers, media_type="text/javascript")

    return serve
