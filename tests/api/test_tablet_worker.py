"""The tablet's service worker is served so that browsers take it, and notice a new one."""

from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.api.pages import install_pages


@pytest.mark.parametrize("built", [True, False])
def test_the_worker_is_a_script_that_is_asked_for_anew(tmp_path: Path, *, built: bool) -> None:
    """At the root, so that it may look after the page beside it; without a build there is none."""
    if built:
        (tmp_path / "tablet-worker.js").write_text("self.BUILD={};")
    app = FastAPI()
    install_pages(app, tmp_path)
    answer = TestClient(app).get("/tablet-worker.js")
    assert answer.status_code == (200 if built else 404)
    if built:
        assert answer.headers["content-type"].split(";")[0] == "text/javascript"
        assert answer.headers["cache-control"] == "no-cache"
