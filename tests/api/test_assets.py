"""Tests of how scripts and styles are sent to browsers."""

import gzip
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.api.pages import WASM_POLICY, Assets, install_pages

SCRIPT = "export const words = 'a script of some length';\n" * 100


@pytest.fixture
def client(tmp_path: Path) -> TestClient:
    """Return a client of an application that serves a script, a tiny one and a picture."""
    (tmp_path / "page.js").write_text(SCRIPT)
    (tmp_path / "tiny.js").write_text("export {};\n")
    (tmp_path / "picture.png").write_bytes(bytes(4000))
    app = FastAPI()
    app.mount("/assets", Assets(directory=tmp_path))
    return TestClient(app)


def test_a_script_is_sent_compressed_and_cacheable(client: TestClient) -> None:
    """A script is sent compressed with gzip and may be cached, depending on the encoding."""
    with client.stream("GET", "/assets/page.js", headers={"accept-encoding": "gzip"}) as answer:
        wire = b"".join(answer.iter_raw())
    assert gzip.decompress(wire).decode() == SCRIPT
    assert len(wire) < len(SCRIPT) / 10
    assert answer.headers["content-encoding"] == "gzip"
    assert answer.headers["vary"] == "Accept-Encoding"
    assert answer.headers["content-type"].startswith("text/javascript")
    assert "immutable" in answer.headers["cache-control"]


@pytest.mark.parametrize("accepted", ["identity", "br", "gzip;q=0"])
def test_a_client_without_gzip_gets_the_plain_file(client: TestClient, accepted: str) -> None:
    """A client that does not accept gzip gets the plain file, with the right `Vary`."""
    answer = client.get("/assets/page.js", headers={"accept-encoding": accepted})
    assert "content-encoding" not in answer.headers
    assert answer.text == SCRIPT
    assert answer.headers["vary"] == "Accept-Encoding"


def test_what_the_build_has_compressed_is_sent_to_those_who_take_it(
    client: TestClient, tmp_path: Path
) -> None:
    """The bytes beside the script are sent as they are, as a script; others get gzip."""
    (tmp_path / "page.js.br").write_bytes(b"as the build wrote it")
    offered = {"accept-encoding": "gzip, deflate, br;q=0.9"}
    with client.stream("GET", "/assets/page.js", headers=offered) as answer:
        wire = b"".join(answer.iter_raw())
    assert wire == b"as the build wrote it"
    assert answer.headers["content-encoding"] == "br"
    assert answer.headers["vary"] == "Accept-Encoding"
    assert answer.headers["content-type"].startswith("text/javascript")
    assert "immutable" in answer.headers["cache-control"]
    for refused in ("gzip", "gzip, br;q=0"):
        other = client.get("/assets/page.js", headers={"accept-encoding": refused})
        assert other.headers["content-encoding"] == "gzip"
        assert other.text == SCRIPT


@pytest.mark.parametrize("name", ["tiny.js", "picture.png"])
def test_small_and_compressed_files_are_not_compressed(client: TestClient, name: str) -> None:
    """Small files and those that are compressed already are sent unchanged."""
    answer = client.get(f"/assets/{name}", headers={"accept-encoding": "gzip"})
    assert answer.status_code == 200
    assert "content-encoding" not in answer.headers


def test_only_the_workers_for_webassembly_may_run_it(client: TestClient, tmp_path: Path) -> None:
    """Only workers for WebAssembly may run it, and only three of them code made from text."""
    (tmp_path / "wasm").mkdir()
    for script in ("short.js", "long.js"):
        (tmp_path / "wasm" / script).write_text(SCRIPT if script == "long.js" else "1;\n")
        policy = client.get(f"/assets/wasm/{script}").headers["content-security-policy"]
        assert "'wasm-unsafe-eval'" in policy
        assert "'unsafe-eval'" not in policy
        assert "default-src 'none'" in policy
    for evaluating in ("textureWorker-1.js", "bodiesWorker-1.js", "tryoutWorker-1.js"):
        (tmp_path / "wasm" / evaluating).write_text("1;\n")
        policy = client.get(f"/assets/wasm/{evaluating}").headers["content-security-policy"]
        assert policy == f"{WASM_POLICY} 'unsafe-eval'"
    # On Windows, the file's path has backslashes; here they are part of its name.
    (tmp_path / "wasm\\textureWorker-2.js").write_text("1;\n")
    windows = client.get("/assets/wasm%5CtextureWorker-2.js")
    assert (windows.status_code, windows.headers["content-security-policy"]) == (200, policy)
    assert "content-security-policy" not in client.get("/assets/page.js").headers


def test_webassembly_is_sent_compressed(client: TestClient, tmp_path: Path) -> None:
    """WebAssembly is sent compressed, since a headset fetches ten megabytes of it."""
    (tmp_path / "physics.wasm").write_bytes(bytes(4000))
    answer = client.get("/assets/physics.wasm", headers={"accept-encoding": "gzip"})
    assert answer.headers["content-type"] == "application/wasm"
    assert answer.headers["content-encoding"] == "gzip"


def test_only_the_headsets_page_is_isolated_and_workers_may_run_in_it(tmp_path: Path) -> None:
    """The headset's page alone is cross-origin isolated, and scripts may run in it as workers."""
    for name in ("console", "tablet", "vr"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "index.html").write_text("<!doctype html>")
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "worker.js").write_text("1;\n")
    app = FastAPI()
    install_pages(app, tmp_path)
    client = TestClient(app)
    embedder = "cross-origin-embedder-policy"
    for address in ("/vr", "/assets/worker.js"):
        assert client.get(address).headers[embedder] == "require-corp"
    for address in ("/", "/tablet"):
        assert embedder not in client.get(address).headers
