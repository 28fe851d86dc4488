"""Tests that `npm run dev` serves pages that work with a running server."""

import os
import re
import signal
import subprocess
import time
from collections.abc import Iterator

import httpx2
import pytest

from tests.support.node import NODE, NPM, install_packages, node_environment
from tests.support.server import ADMIN_PASSWORD, LiveServer, free_port
from tests.support.stages import FRONTEND

STARTS_WITHIN_S = 120.0


@pytest.fixture(scope="module")
def dev_server(shared_server: LiveServer) -> Iterator[str]:
    """Provide the URL of a dev server in front of the real one."""
    install_packages(FRONTEND)
    port = free_port()
    options = ["--host", "127.0.0.1", "--port", str(port), "--strictPort"]
    process = subprocess.Popen(
        [NODE, NPM, "run", "--silent", "dev", "--", *options],
        cwd=FRONTEND,
        env={**node_environment(), "REEMBODY_URL": f"http://127.0.0.1:{shared_server.port}"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        wait_for(f"http://127.0.0.1:{port}/api/health")
        yield f"http://127.0.0.1:{port}"
    finally:
        # npm does not pass the signal on to its child processes.
        os.killpg(process.pid, signal.SIGTERM)
        process.wait()


def wait_for(url: str) -> None:
    """Wait until the URL responds."""
    deadline_s = time.monotonic() + STARTS_WITHIN_S
    while True:
        try:
            httpx2.get(url, timeout=30.0)
        except httpx2.TransportError:
            assert time.monotonic() < deadline_s, f"{url} does not answer"
            time.sleep(0.1)
        else:
            return


def test_the_dev_server_passes_requests_on(dev_server: str) -> None:
    """The dev server passes API requests on to the server."""
    assert httpx2.get(f"{dev_server}/api/health", timeout=30.0).json()["status"] == "ok"


@pytest.mark.parametrize("path", ["/", "/console", "/tablet"])
def test_every_page_is_served_with_its_scripts(dev_server: str, path: str) -> None:
    """Every script and icon that a page names is served relative to the page's URL."""
    page = httpx2.get(f"{dev_server}{path}", timeout=30.0)
    named = re.findall(r'(?:src|href)="([^"]+\.(?:tsx?|svg))"', page.text)
    assert len(named) >= 2
    for name in named:
        answer = httpx2.get(page.url.join(name), timeout=60.0)
        assert answer.status_code == 200, name


@pytest.mark.parametrize(
    ("origin", "status"), [("own", 200), ("http://elsewhere.example", 403), ("null", 403)]
)
def test_only_its_own_pages_may_change_something(dev_server: str, origin: str, status: int) -> None:
    """Through the dev server, only its own pages may send requests that change data."""
    answer = httpx2.post(
        f"{dev_server}/api/login",
        json={"username": "admin", "password": ADMIN_PASSWORD},
        headers={"origin": dev_server if origin == "own" else origin},
        timeout=30.0,
    )
    assert answer.status_code == status
