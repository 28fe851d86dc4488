"""Tests that the examples of docs/scripting.md work as described, against a real server."""

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.server import ADMIN_PASSWORD, LiveServer

PAGE = Path(__file__).parents[2] / "docs" / "scripting.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
STUDY = "reembodiment-latency"


def examples(language: str) -> str:
    """Return all blocks of one language, in the order of the page."""
    blocks = [text for name, text in BLOCK.findall(PAGE.read_text("utf-8")) if name == language]
    assert blocks
    return "\n".join(blocks)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide a server, and a `./run` that uses the server's data."""
    with LiveServer(tmp_path_factory.mktemp("scripting")) as running:
        folder = running.data_dir.parent
        there = f'REEMBODY_DATA_DIR="{running.data_dir}"'
        (folder / "run").write_text(f'#!/bin/sh\n{there} exec "{sys.executable}" -m app.cli "$@"\n')
        (folder / "run").chmod(0o700)
        yield running


def run(server: LiveServer, *command: str, token: str = "") -> str:
    """Run a program that must succeed, and return its output."""
    done = subprocess.run(
        command,
        cwd=server.data_dir.parent,
        env={
            "PATH": f"{Path(sys.executable).parent}:/usr/bin:/bin",
            "PYTHONPATH": str(PAGE.parents[1]),
            "REEMBODY_URL": server.url,
            "REEMBODY_TOKEN": token,
        },
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_python_examples_go_from_a_token_to_an_erasure(server: LiveServer) -> None:
    """The Python examples run as one script from a token to an erasure.

    The server's audit trail contains each step. The token of a login works like one that the
    command creates.
    """
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        token = next(value for key, value in client.cookies.items() if "reembody" in key.lower())
    said = run(server, sys.executable, "-c", examples("python"), token=token).splitlines()
    assert said[0] == "signed in as admin"
    assert said[1].startswith("give this to the person: http")
    assert said[2].startswith("participant ")
    assert said[3].startswith("active next: ")
    assert said[4].startswith("slots: ['open'")
    assert said[5].startswith("erased; copies to destroy: [")
    assert len(list(server.data_dir.parent.glob("*.zip"))) == 1
    with server.client() as admin:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        admin.post("/api/login", json=credentials).raise_for_status()
        (person,) = admin.get(f"/api/studies/{STUDY}/participants").json()
        assert person["erasure"] is not None
        (session,) = admin.get(f"/api/studies/{STUDY}/sessions").json()
        assert session["status"] == "withdrawn"
        names = {one["username"] for one in admin.get("/api/accounts").json()}
    assert names == {"admin", "ada"}


@pytest.mark.skipif(shutil.which("curl") is None, reason="curl is not installed")
def test_the_shell_examples_go_from_a_token_to_an_export(server: LiveServer) -> None:
    """The shell examples run from a token, made by a command, to a planned session's export."""
    with server.client() as admin:
        assert admin.get("/api/openapi.json").json()["info"]["title"]
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        admin.post("/api/login", json=credentials).raise_for_status()
        made = admin.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"}).json()
        run(server, "sh", "-eu", "-c", examples("sh"))
        notes = admin.get(f"/api/sessions/{made['id']}").json()["notes"]
    assert [note["text"] for note in notes] == ["Written by a script."]
    assert (server.data_dir.parent / "export.zip").read_bytes().startswith(b"PK")
