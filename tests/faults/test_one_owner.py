"""Tests that a second server or a writing command is refused on data that a server uses.

The short form repeats each attempt a few times, `--long` fifty times.
"""

import asyncio
import contextlib
import json
import os
import signal
import subprocess
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import httpx2
import pytest
from sqlalchemy import func, select

from app.features.record.sessions import events_of
from app.models import SessionEvent
from app.rehearsal.cast import answer, operate
from app.rehearsal.rehearse import RehearsalPlan, assembled
from tests.faults.commands import UNUSABLE, command, reembody
from tests.faults.figures import note
from tests.faults.record import record_of
from tests.faults.short_study import KEY, Watch, add_short_study
from tests.rehearsal.ledger import LedgerJournal
from tests.support.nursery import Child, Wish, nursery
from tests.support.postgres import fresh_postgres
from tests.support.server import ADMIN_PASSWORD, LiveServer, free_port

SHORT, LONG = 3, 50
HAND = 2
"""The id of the first task phase."""
CREDENTIALS = {"username": "admin", "password": ADMIN_PASSWORD}
ANSWERS_WITHIN_S = 60.0
SOFT = '{"operation": "set_gains", "targets": ["left_arm"], "kp_nm_per_rad": 50}'
HEADLESS = '{"operation": "remove_parts", "targets": ["Head"]}'


@pytest.fixture
def times(request: pytest.FixtureRequest) -> int:
    """Provide the number of attempts."""
    return LONG if request.config.getoption("--long") else SHORT


def test_of_two_servers_started_simultaneously_one_serves(tmp_path: Path, times: int) -> None:
    """Of two servers started simultaneously one serves and the other exits with a message.

    A running session gets no event from it.
    """
    server = LiveServer(tmp_path / "live")
    with server:
        session_id = running_session(server)
    before = event_count(server, session_id)
    outcomes = []
    for _ in range(times):
        with pair(server, server._full_environment()) as (serving, refused):
            outcomes.append(len(serving))
            for child, said in refused:
                assert child.wait(60.0) == UNUSABLE, said.read_text()
                assert f"process id {serving[0].pid}" in said.read_text()
                assert "Traceback" not in said.read_text()
    note(40, f"{times} pairs", "times that exactly one served", outcomes.count(1))
    assert outcomes == [1] * times
    added = event_count(server, session_id) - before
    note(40, f"{times} pairs", "events added to a session that was paused", added)
    assert added == 0


def test_a_second_server_affects_no_phase_and_no_export(
    live_server: LiveServer, times: int
) -> None:
    """A second server is refused without affecting a running phase or an export.

    The message is one line with the process id and the port.
    """
    asyncio.run(refused_beside_a_running_phase(live_server, times))


async def refused_beside_a_running_phase(server: LiveServer, times: int) -> None:
    """Start second servers one after the other while a task phase runs, and count the refusals."""
    plan = RehearsalPlan(
        server.url, add_short_study(server), speed=1.0, seed=3, password=ADMIN_PASSWORD
    )
    async with assembled(plan, journal=LedgerJournal()) as cast, asyncio.TaskGroup() as group:
        playing = [
            group.create_task(work) for work in (cast.headset.run(), operate(cast), answer(cast))
        ]
        await Watch(cast).running(HAND)
        refused = await asyncio.to_thread(second_servers, server, times)
        for task in playing:
            task.cancel()
        session_id = cast.operator.session_id
    with record_of(server) as db:
        payloads = [str(event.payload) for event in events_of(db, session_id)]
    note(40, f"{times} starts on a served folder", "refused", refused)
    note(40, f"{times} starts on a served folder", "pauses it made", paused(payloads))
    assert refused == times
    assert paused(payloads) == 0


def second_servers(server: LiveServer, times: int) -> int:
    """Return how many second servers were refused correctly while an export stays available."""
    with server.client() as client:
        assert client.post("/api/login", json=CREDENTIALS).is_success
        export, refused = made_export(client), 0
        for _ in range(times):
            said = reembody(server, "serve", "--port", free_port())
            assert f"process id {server.pid} on port {server.port}" in said.err
            assert said.err.count("\n") == 1
            refused += said.code == UNUSABLE
        assert client.get(f"/api/exports/{export}/file").is_success
        assert client.get("/api/health").json()["status"] == "ok"
        return refused


def paused(payloads: Sequence[str]) -> int:
    """Return how many events pause a phase because a server restarted."""
    return sum("server_restarted" in payload for payload in payloads)


def test_commands_that_write_are_refused_and_those_that_read_are_not(
    live_server: LiveServer, tmp_path: Path
) -> None:
    """While a server runs, a restore and a second server are refused, and other commands work."""
    session_id, file = running_session(live_server), tmp_path / "all.reembody"
    works = [
        ("backup", file),
        ("verify", "--session", session_id),
        ("export", "--study", KEY, "--kind", "test", "--to", tmp_path / "export"),
        ("token",),
        ("tls", "show"),
        ("avatar", "edit", "standard", "--operation", SOFT, "--save", "soft"),
    ]
    for arguments in works:
        said = reembody(live_server, *arguments)
        assert said.code in (0, 1), said.err
        assert "in use" not in said.err
    before = event_count(live_server, session_id)
    for arguments in (
        ("restore", file, "--replace", "--even-though-active"),
        ("rehearse", "--data", live_server.data_dir),
    ):
        said = reembody(live_server, *arguments)
        assert said.code == UNUSABLE, said.err
        assert f"process id {live_server.pid} on port {live_server.port}" in said.err
        assert "Traceback" not in said.err
    assert event_count(live_server, session_id) == before


def test_avatars_are_read_and_stored_through_a_server_and_beside_it(
    live_server: LiveServer, tmp_path: Path
) -> None:
    """A command stores in its own installation and at a URL alike, and the other one sees it."""
    url = f"http://127.0.0.1:{live_server.port}"
    at = ("--url", url, "--token", reembody(live_server, "token").out.strip())

    def avatar(*arguments: object) -> dict[str, Any]:
        return reembody(live_server, "avatar", *arguments, "--json").json

    soft = tmp_path / "soft.json"
    beside = avatar("edit", "standard", "--operation", SOFT, "--save", "beside", "--out", soft)
    asked = avatar("edit", "standard", "--operation", SOFT, "--save", "asked", *at)
    assert asked["configuration"] == beside["configuration"]
    assert avatar("diff", "asked", "beside", *at)["same"]
    stiff = SOFT.replace("50", "900")
    assert (
        avatar("edit", "beside", "--operation", stiff, "--save", "beside", *at)["saved"]["version"]
        == 2
    )
    back = avatar("save", soft, "beside", "--based-on", "2", "--note", "back", *at)
    assert back["version"] == 3
    assert avatar("diff", "beside@1", "beside@3")["same"]
    listed = [reembody(live_server, "avatar", "list", "--json", *more) for more in ((), at)]
    here, there = (
        {
            one["key"]: [row["content_hash"] for row in one["versions"]]
            for one in json.loads(said.out)
        }
        for said in listed
    )
    assert here == there
    for arguments, reason in (
        (("show", "besides", *at), "Did you mean beside?"),
        (("show", "beside", "--url", url, "--token", "wrong"), "reembody token"),
        (("edit", "beside", "--operation", HEADLESS, "--save", "beside", *at), "without Head"),
    ):
        said = reembody(live_server, "avatar", *arguments)
        assert (said.code, reason in said.err) == (UNUSABLE, True), said.err


def test_a_running_servers_database_is_refused_under_another_name(
    live_server: LiveServer, tmp_path: Path
) -> None:
    """A running server's database is refused when named by an SQLite URI or through a hard link.

    With either name, the lock would be taken in another folder. The attempt creates no file.
    """
    file, other = live_server.data_dir / "reembody.sqlite", tmp_path / "other"
    other.mkdir()
    environment = {"REEMBODY_DATA_DIR": str(other)}
    address = {"REEMBODY_DATABASE_URL": f"sqlite:///file:{file}?uri=true"}
    said = command(environment | address, "serve", "--port", free_port())
    assert said.code == UNUSABLE
    assert "names its file as file:" in said.err
    assert list(other.iterdir()) == []
    second = other / file.name
    os.link(file, second)
    try:
        for arguments in (
            ("serve", "--port", free_port()),
            ("restore", tmp_path / "none.reembody", "--replace"),
            ("backup", tmp_path / "all.reembody"),
            ("token",),
        ):
            said = command(environment, *arguments)
            assert said.code == UNUSABLE, said.err
            assert f"{second} has 2 names (hard links)" in said.err
            assert "Traceback" not in said.err
        assert [one.name for one in other.iterdir()] == [file.name]
    finally:
        second.unlink()


def test_a_database_of_postgres_has_one_server(tmp_path: Path) -> None:
    """A PostgreSQL database has only one server, even if the data folders differ.

    This holds for servers started simultaneously and one after the other.
    """
    with fresh_postgres() as url:
        server = LiveServer(tmp_path / "live", environment={"REEMBODY_DATABASE_URL": url})
        other = LiveServer(tmp_path / "other", environment={"REEMBODY_DATABASE_URL": url})
        with pair(server, server._full_environment(), other._full_environment()) as (serving, _):
            assert len(serving) == 1
        with server:
            said = reembody(other, "serve", "--port", free_port())
            assert said.code == UNUSABLE
            assert f"process id {server.pid} on port {server.port}" in said.err
            # A killed server leaves nothing behind that would block the next one.
            server.kill()
            with other:
                pass


def test_a_server_starts_immediately_after_a_kill(tmp_path: Path) -> None:
    """A server can be started immediately after its predecessor was killed.

    The lock ends with its process, with or without workers.
    """
    server = LiveServer(tmp_path / "live")
    for _ in range(2):
        server.start()
        server.kill()
    with server:
        pass


@contextlib.contextmanager
def pair(
    server: LiveServer, *environments: Mapping[str, str]
) -> Iterator[tuple[list[Child], list[tuple[Child, Path]]]]:
    """Start two servers simultaneously, each on its own port.

    Yield those that serve, and those that do not with their log files.
    """
    folder = server.data_dir.parent
    folder.mkdir(parents=True, exist_ok=True)
    children: list[tuple[Child, int, Path]] = []
    for at in range(2):
        port, said = free_port(), folder / f"pair-{at}-{free_port()}.log"
        environment = dict(environments[min(at, len(environments) - 1)])
        wish = Wish(["serve", "--port", str(port)], environment, folder, said)
        children.append((nursery().start(wish), port, said))
    try:
        serving = [child for child, port, _ in children if _serves(child, port)]
        refused = [(child, said) for child, _, said in children if child not in serving]
        yield serving, refused
    finally:
        for child, _, _ in children:
            child.send_signal(signal.SIGTERM)
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(30.0)
            child.kill()
            child.wait()


def _serves(child: Child, port: int) -> bool:
    give_up_s = time.monotonic() + ANSWERS_WITHIN_S
    while child.poll() is None and time.monotonic() < give_up_s:
        try:
            return httpx2.get(f"http://127.0.0.1:{port}/api/health").is_success
        except httpx2.TransportError:
            time.sleep(0.05)
    return False


def running_session(server: LiveServer) -> str:
    """Start a session of the short study and return its id."""
    key = add_short_study(server)
    with server.client() as client:
        assert client.post("/api/login", json=CREDENTIALS).is_success
        made = client.post(f"/api/studies/{key}/sessions", json={"kind": "test"}).json()
        body = {"command_id": "a" * 32, "expected_version": made["version"], "type": "start"}
        assert client.post(f"/api/sessions/{made['id']}/commands", json=body).is_success
        return str(made["id"])


def event_count(server: LiveServer, session_id: str) -> int:
    """Return how many events a session has."""
    with record_of(server) as db:
        query = select(func.count()).where(SessionEvent.session_id == session_id)
        return db.scalar(query) or 0


def made_export(client: httpx2.Client) -> str:
    """Create an export, wait until it is ready and return its id."""
    ordered = client.post(f"/api/studies/{KEY}/exports", json={"kind": "test"})
    assert ordered.is_success, ordered.text
    export_id = str(ordered.json()["id"])
    give_up_s = time.monotonic() + ANSWERS_WITHIN_S
    while time.monotonic() < give_up_s:
        view = client.get(f"/api/exports/{export_id}").json()
        if view["state"] == "ready":
            return export_id
        assert view["state"] != "failed", json.dumps(view)
        time.sleep(0.1)
    pytest.fail("the export is not made")
