"""Tests of how the tablet's service worker is served."""

from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.api.pages import install_pages


@pytest.mark.parametrize("built", [True, False])
def test_the_service_worker_is_served_without_caching(tmp_path: Path, *, built: bool) -> None:
    """The service worker is an uncached script at the root, and missing without a build."""
    if built:
        (tmp_path / "tablet-worker.js").write_text("self.BUILD={};")
    app = FastAPI()
    install_pages(app, tmp_path)
    answer = TestClient(app).get("/tablet-worker.js")
    assert answer.status_code == (200 if built else 404)
    if built:
        assert answer.headers["content-type"].split(";")[0] == "text/javascript"
        assert answer.headers["cache-control"] == "no-cache"
