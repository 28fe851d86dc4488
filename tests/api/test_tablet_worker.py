"""Tests of how the tablet's page and its service worker are served."""

from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.api.pages import PAGES, install_pages


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


def test_a_page_opens_without_an_answer_that_fails(tmp_path: Path) -> None:
    """What is written into a page cannot end its element; if it fails, the page comes without."""
    (tmp_path / "tablet").mkdir()
    html = "<html><head><title>x</title></head><body></body></html>"
    (tmp_path / "tablet/index.html").write_text(html)
    answers = iter(['{"state": "</script><b>"}'])
    app = FastAPI()
    install_pages(app, tmp_path, {"/tablet": lambda _: next(answers)})
    client = TestClient(app)
    element = '<script type="application/json" id="first-answer">'
    written = client.get("/tablet").text
    assert written.count("</script>") == 1
    assert f'{element}{{"state": "\\u003c/script>\\u003cb>"}}</script></head>' in written
    assert client.get("/tablet").text == html


def served_page(folder: Path, address: str) -> TestClient:
    """Return a client of a server that has only this page."""
    file = folder / PAGES[address]
    file.parent.mkdir()
    file.write_text("<html><head></head><body></body></html>")
    app = FastAPI()
    install_pages(app, folder)
    return TestClient(app, follow_redirects=False)


def test_a_page_answers_a_request_for_its_headers(tmp_path: Path) -> None:
    """Monitors and link checkers ask with HEAD, and get the status and headers of the page."""
    asked = served_page(tmp_path, "/tablet").head("/tablet")
    assert (asked.status_code, asked.content) == (200, b"")
    assert asked.headers["content-type"] == "text/html; charset=utf-8"


@pytest.mark.parametrize("address", list(PAGES))
def test_an_address_may_end_with_a_slash(tmp_path: Path, address: str) -> None:
    """A page is sent at once at its address with a slash, too."""
    client = served_page(tmp_path, address)
    with_slash = client.get(f"{address.rstrip('/')}/")
    assert (with_slash.status_code, with_slash.text) == (200, client.get(address).text)


@pytest.mark.parametrize(
    ("address", "site", "policy"),
    [
        ("/tablet", "none", "unsafe-none"),
        ("/tablet", "cross-site", None),
        ("/tablet", "same-origin", None),
        ("/tablet", None, None),
        ("/", "none", None),
        ("/vr", "none", None),
    ],
)
def test_only_a_tablet_that_a_person_opens_is_not_cut_off(
    tmp_path: Path, address: str, site: str | None, policy: str | None
) -> None:
    """A page that another page opened, or may have opened, keeps the policy of all answers."""
    client = served_page(tmp_path, address)
    headers = {} if site is None else {"sec-fetch-site": site}
    answer = client.get(address, headers=headers)
    assert answer.headers.get("cross-origin-opener-policy") == policy
    assert ("sec-fetch-site" in answer.headers.get("vary", "")) == (address == "/tablet")
