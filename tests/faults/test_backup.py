"""Tests of backups made under load, and of the data present after a restore.

Fault 29 of the matrix, with the real server and the real commands. A session streams while the
backup is made; the data are compared with the headset's own journal as it was before the command.
"""

import asyncio
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import httpx2
import pytest
from sqlalchemy.orm import Session

from app.database import open_database
from app.features.care.backups.digest import overall
from app.features.care.backups.reading import digests, opened_backup
from app.features.record.sessions import events_of, verify_chain
from app.rehearsal.cast import answer, operate
from app.rehearsal.rehearse import RehearsalPlan, assembled, rehearse
from tests.faults.commands import UNUSABLE, CommandResult, reembody
from tests.faults.figures import note
from tests.faults.short_study import Watch, add_short_study
from tests.rehearsal.ledger import Key, LedgerJournal, reconcile
from tests.support.postgres import fresh_postgres
from tests.support.server import ADMIN_PASSWORD, LiveServer

SPEED = 4.0
HAND = 2
"""The id of the first task phase."""
CREDENTIALS = {"username": "admin", "password": ADMIN_PASSWORD}


@contextmanager
def installation(folder: Path, engine: str) -> Iterator[LiveServer]:
    """Yield a server that has not been started, on the named database engine."""
    if engine == "sqlite":
        yield LiveServer(folder)
        return
    with fresh_postgres() as url:
        yield LiveServer(folder, environment={"REEMBODY_DATABASE_URL": url})


@contextmanager
def record(server: LiveServer) -> Iterator[Session]:
    """Open the database of a server, on either engine."""
    url = server._full_environment().get("REEMBODY_DATABASE_URL")
    database = open_database(url or f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
    try:
        with database.reading() as db:
            yield db
    finally:
        database.close()


@dataclass
class Made:
    """A backup made while a session streamed; `acked` was acknowledged before the command."""

    session_id: str
    said: CommandResult
    acked: dict[Key, int]


async def stream_and_back_up(server: LiveServer, ledger: LedgerJournal, to: Path) -> Made:
    """Run a session to its end and make a backup in the middle of its first task phase.

    The tablet waits for the backup, so the session streams until it is complete.
    """
    plan = RehearsalPlan(
        server.url, add_short_study(server), speed=SPEED, seed=3, password=ADMIN_PASSWORD
    )
    async with assembled(plan, journal=ledger) as cast, asyncio.TaskGroup() as group:
        group.create_task(cast.headset.run())
        operating = group.create_task(operate(cast))
        answering = group.create_task(answer(cast))
        await Watch(cast).running(HAND)
        answering.cancel()
        acked = dict(ledger.acked)
        said = await asyncio.to_thread(reembody, server, "backup", to, "--json")
        group.create_task(answer(cast))
        await operating
        view = await cast.operator.view()
        assert view["status"] == "completed"
        return Made(cast.operator.session_id, said, acked)


@pytest.mark.parametrize(
    ("origin", "target"),
    [
        pytest.param("sqlite", "sqlite", marks=pytest.mark.long),
        ("postgresql", "sqlite"),
        ("sqlite", "postgresql"),
    ],
)
def test_a_backup_under_load_is_restored_whole(tmp_path: Path, origin: str, target: str) -> None:
    """A backup made under load restores to an equal hash, and the session in it can continue.

    It contains every frame that was acknowledged before the command.
    """
    ledger, file = LedgerJournal(), tmp_path / "all.reembody"
    with installation(tmp_path / "first", origin) as server, server:
        made = asyncio.run(stream_and_back_up(server, ledger, file))
        with record(server) as db:
            undisturbed = reconcile(db, made.session_id, ledger)
    assert undisturbed.sound
    assert undisturbed.stored == undisturbed.sent
    summary = made.said.json
    with installation(tmp_path / "second", target) as second:
        restored = reembody(second, "restore", file, "--json")
        assert restored.json["sha256"] == summary["sha256"]
        with record(second) as db:
            check_rows(db, file)
            found = reconcile(db, made.session_id, replace(ledger, acked=made.acked))
            chain = verify_chain(events_of(db, made.session_id))
        assert found.sound
        assert chain.ok
        assert found.stored >= sum(made.acked.values()) > 0
        began_s = time.monotonic()
        with second:
            serves_s = restored.took_s + time.monotonic() - began_s
            go_on(second, made.session_id)
    what = f"{origin} to {target}"
    held = f"{sum(made.acked.values())} / {found.stored}"
    note(29, what, "acknowledged before the command / in the backup", held)
    note(29, what, "of those lost or altered", found.lost + found.altered)
    note(29, what, "RPO: age of the backup when it was there (s)", summary["duration_s"])
    note(29, what, "RTO: restored and served again (s)", serves_s)
    note(29, what, "size of the backup (MB)", file.stat().st_size / 1e6)


def check_rows(db: Session, file: Path) -> None:
    """Assert that every table equals the backup's, except for what a restore changes afterwards.

    The clock of the running phase was stopped (its session's rows), its open alarms were ended, and
    the headset was unpaired.
    """
    with opened_backup(file) as backup:
        now = digests(db.connection(), backup.shapes)
        changed = {name for name, one in now.items() if one != backup.tables[name]}
        assert overall(backup.manifest.revision, backup.tables) == backup.manifest.sha256
    assert changed <= {"devices", "sessions", "session_events", "phases", "alarms"}


def go_on(server: LiveServer, session_id: str) -> None:
    """Assert that the session is at the same step with its clock stopped; pair its headset."""
    with server.client() as client:
        assert client.post("/api/login", json=CREDENTIALS).is_success
        view = client.get(f"/api/sessions/{session_id}").json()
        assert view["status"] == "active"
        assert view["current"]["status"] != "running"
        assert [device["kind"] for device in view["devices"]] == ["tablet"]
        pairing = client.post(f"/api/sessions/{session_id}/pairings", json={"device": "headset"})
        pair = {"code": pairing.json()["code"], "name": "the same headset"}
        assert client.post("/api/devices/pair", json=pair).is_success


@pytest.mark.parametrize("engine", ["sqlite", pytest.param("postgresql", marks=pytest.mark.long)])
def test_a_restore_needs_a_stopped_server_and_brings_the_backups_data(
    tmp_path: Path, engine: str
) -> None:
    """A restore is refused while a server runs; after it, all data are those of the backup."""
    with installation(tmp_path / "live", engine) as server, server, server.client() as client:
        study = add_short_study(server)
        assert client.post("/api/login", json=CREDENTIALS).is_success
        kept = join(client, study, "kept")
        assert reembody(server, "backup", tmp_path / "all.reembody").code == 0
        later = join(client, study, "later")
        beside = reembody(server, "restore", tmp_path / "all.reembody", "--replace")
        assert beside.code == UNUSABLE
        assert f"process id {server.pid} on port {server.port}" in beside.err
        assert client.get(f"/api/sessions/{later}").json()["participant_code"] == "later"
        server.stop()
        refused = reembody(server, "restore", tmp_path / "all.reembody")
        assert refused.code == UNUSABLE
        assert "--replace" in refused.err
        done = reembody(server, "restore", tmp_path / "all.reembody", "--replace", "--json").json
        server.start()
        assert Path(done["before"]).parent == server.data_dir / "backups"
        assert client.get(f"/api/sessions/{kept}").json()["participant_code"] == "kept"
        assert client.get(f"/api/sessions/{later}").status_code == 404
        plan = RehearsalPlan(server.url, study, speed=2 * SPEED, seed=4, password=ADMIN_PASSWORD)
        ledger = LedgerJournal()
        report = asyncio.run(rehearse(plan, journal=ledger))
        with record(server) as db:
            assert reconcile(db, report.session_id, ledger).sound
        server.stop()
        back = reembody(server, "restore", done["before"], "--replace", "--json").json
        assert back["rows"] > 0
        server.start()
        assert client.get(f"/api/sessions/{later}").json()["participant_code"] == "later"


def join(client: httpx2.Client, study: str, code: str) -> str:
    """Create a session that has not started and return its id."""
    body = {"kind": "test", "language": "en", "participant_code": code}
    view = client.post(f"/api/studies/{study}/sessions", json=body).json()
    return str(view["id"])


def test_a_restore_is_refused_while_sessions_are_active(
    live_server: LiveServer, tmp_path: Path
) -> None:
    """A restore is refused while sessions are active, lists them, and changes nothing."""
    with live_server.client() as client:
        study = add_short_study(live_server)
        assert client.post("/api/login", json=CREDENTIALS).is_success
        session_id = join(client, study, "P-014")
        view = client.get(f"/api/sessions/{session_id}").json()
        command = {"command_id": "1" * 32, "expected_version": view["version"], "type": "start"}
        started = client.post(f"/api/sessions/{session_id}/commands", json=command)
        assert started.is_success, started.text
        reembody(live_server, "backup", tmp_path / "all.reembody")
        live_server.stop()
        said = reembody(live_server, "restore", tmp_path / "all.reembody", "--replace")
        assert said.code == UNUSABLE
        assert f"P-014 ({session_id})" in said.err
        assert "--even-though-active" in said.err
        assert not (live_server.data_dir / "backups").exists()
        insisting = ("--replace", "--even-though-active")
        assert reembody(live_server, "restore", tmp_path / "all.reembody", *insisting).code == 0
        live_server.start()
        assert client.get(f"/api/sessions/{session_id}").json()["status"] == "active"


def test_a_full_disk_leaves_no_partial_backup(live_server: LiveServer, tmp_path: Path) -> None:
    """A backup to a full disk fails with a message and leaves no file; the server is unaffected."""
    for at, limit in enumerate((50_000, 300_000, 420_000)):
        place = tmp_path / f"usb{at}"
        place.mkdir()
        said = reembody(live_server, "backup", place / "all.reembody", max_file_bytes=limit)
        assert said.code == UNUSABLE, limit
        assert "could not be written" in said.err
        assert "Traceback" not in said.err
        assert list(place.iterdir()) == []
    with live_server.client() as client:
        assert client.post("/api/login", json=CREDENTIALS).is_success
    assert reembody(live_server, "backup", tmp_path / "all.reembody").code == 0
