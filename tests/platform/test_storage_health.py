"""Tests of storage health: failing writes are reported and new work is refused."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.exc import DatabaseError, IntegrityError, OperationalError

from app.clock import Clock
from app.errors import NotDurable
from app.platform.storage_health import StorageHealth
from app.platform.trouble import DAMAGED, FULL, LOCKED, READ_ONLY, REFUSED, Trouble, explain
from tests.features.lab import Lab, error, running_lab
from tests.support.sqlite import fresh_sqlite

START = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)


@dataclass
class Stage:
    """A clock that is set by hand, a disk with a given free space, and recorded announcements."""

    passed_s: float = 0.0
    free: int = 10**12
    announced: list[str] = field(default_factory=list)

    def health(self) -> StorageHealth:
        """Return a storage health with this clock and disk."""
        clock = Clock(
            utc_now=lambda: START + timedelta(seconds=self.passed_s),
            monotonic_ns=lambda: int(self.passed_s * 1e9),
        )
        return StorageHealth(
            clock,
            Path("data"),
            1000,
            on_change=lambda: self.announced.append("changed"),
            free_bytes=lambda _: self.free,
        )


def refusal(code: int) -> OperationalError:
    """Return the error that SQLAlchemy raises for an SQLite result code."""
    origin = sqlite3.OperationalError("in SQLite's words")
    origin.sqlite_errorcode = code
    return OperationalError("INSERT", {}, origin)


def test_a_failure_is_announced_once_and_ends_with_the_next_commit() -> None:
    """A failure is announced once, lasts until the next commit, and counts as one outage."""
    stage = Stage()
    health = stage.health()
    assert (health.state().status, health.take_outages()) == ("ok", ())
    for stage.passed_s in (1.0, 2.0, 3.0):
        health.failed(refusal(sqlite3.SQLITE_FULL))
    state = health.state()
    assert (state.status, state.reason) == ("failing", FULL.message)
    assert state.since == START + timedelta(seconds=1)
    assert len(stage.announced) == 1
    stage.passed_s = 9.0
    health.succeeded()
    health.succeeded()
    assert health.state().status == "ok"
    assert len(stage.announced) == 2
    (outage,) = health.take_outages()
    assert (outage.until - outage.since).total_seconds() == 8.0
    assert health.take_outages() == ()


def test_work_is_refused_while_commits_fail_but_retried() -> None:
    """While commits fail new work is refused, except for one attempt after 5 s without any."""
    stage = Stage()
    health = stage.health()
    health.require_storage()
    health.failed(refusal(sqlite3.SQLITE_IOERR | 3 << 8))
    with pytest.raises(NotDurable) as refused:
        health.require_storage()
    assert REFUSED.message in refused.value.message
    assert refused.value.remedy == REFUSED.remedy
    assert "2026-11-21T12:00:00" in str(refused.value.value)
    stage.passed_s = 5.1
    health.require_storage()
    assert health.state().status == "failing"


def test_low_disk_space_is_reported_before_the_disk_is_full() -> None:
    """Low disk space is reported before the disk is full, and measured again after 5 s."""
    stage = Stage()
    health = stage.health()
    assert not health.state().low_disk
    stage.free = 999
    assert not health.state().low_disk
    stage.passed_s = 5.0
    assert health.state().low_disk
    assert health.state().status == "ok"
    away = StorageHealth(Clock(), Path("nowhere/at/all"), 10**15)
    assert not away.state().low_disk


@pytest.mark.parametrize(
    ("code", "trouble"),
    [
        (sqlite3.SQLITE_FULL, FULL),
        (sqlite3.SQLITE_BUSY, LOCKED),
        (sqlite3.SQLITE_BUSY | 2 << 8, LOCKED),
        (sqlite3.SQLITE_READONLY, READ_ONLY),
        (sqlite3.SQLITE_IOERR | 4 << 8, REFUSED),
        (sqlite3.SQLITE_CORRUPT, DAMAGED),
        (sqlite3.SQLITE_ERROR, None),
        (sqlite3.SQLITE_CONSTRAINT, None),
    ],
)
def test_sqlite_result_codes_are_explained(code: int, trouble: Trouble | None) -> None:
    """SQLite result codes, also extended ones, are explained by the right message."""
    assert explain(refusal(code)) == trouble


@pytest.mark.parametrize(
    ("state", "trouble"),
    [("53100", FULL), ("57P01", REFUSED), ("08006", REFUSED), ("40P01", None), ("55P03", None)],
)
def test_postgresql_states_are_explained(state: str, trouble: Trouble | None) -> None:
    """A full disk or a lost server is explained as trouble; a deadlock or timeout is not."""
    origin = type("Refusal", (Exception,), {"sqlstate": state})()
    assert explain(OperationalError("INSERT", {}, origin)) == trouble


def test_only_connection_errors_without_a_code_are_trouble() -> None:
    """An error without a code is trouble if it concerns the connection, not a constraint."""
    assert explain(OperationalError("BEGIN", {}, Exception("gone"))) == REFUSED
    assert explain(IntegrityError("INSERT", {}, Exception("unique"))) is None
    assert explain(RuntimeError("a bug")) is None


@pytest.fixture
def small_lab(tmp_path: Path) -> Iterator[tuple[Lab, Path]]:
    """Yield an application on SQLite and the path of its database."""
    file = tmp_path / "reembody.sqlite"
    with running_lab(fresh_sqlite(file)) as lab:
        yield lab, file


def test_new_work_is_refused_while_storage_fails(
    small_lab: tuple[Lab, Path],
) -> None:
    """While storage fails, sessions, starts and pairings are refused, and reading still works."""
    lab, _ = small_lab
    view = lab.join(kind="test")
    code = lab.show_code(view["id"], "headset")
    lab.context.storage.failed(refusal(sqlite3.SQLITE_FULL))
    pairings = f"/api/sessions/{view['id']}/pairings"
    refused = [
        lab.try_join(kind="test"),
        lab.try_command(view, "start"),
        lab.operator.post(pairings, json={"device": "tablet"}),
        lab.stranger().post("/api/devices/pair", json={"code": code}),
    ]
    for answer in refused:
        problem = error(answer, 503, "not_durable")
        assert FULL.message in problem["message"]
        assert problem["remedy"] == FULL.remedy
    assert lab.view(view["id"])["status"] == "planned"
    health = lab.stranger().get("/api/health").json()
    assert (health["status"], health["storage"]) == ("ok", "failing")
    assert (health["storage_reason"], health["low_disk"]) == (FULL.message, False)
    # A note is accepted if it can be stored, which shows that storage works again.
    lab.command(view, "note", text="the disk was full")
    assert lab.stranger().get("/api/health").json()["storage"] == "ok"
    lab.command(lab.view(view["id"]), "start")


def test_a_lock_of_another_program_is_reported_until_released(small_lab: tuple[Lab, Path]) -> None:
    """While another program locks the database, writes are refused with that reason."""
    lab, file = small_lab
    view = lab.join(kind="test")
    with closing(sqlite3.connect(file, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        for _ in range(2):
            problem = error(lab.try_command(view, "note", text="hello"), 503, "not_durable")
            assert LOCKED.message in problem["message"]
            assert LOCKED.remedy in problem["remedy"]
        assert lab.stranger().get("/api/health").json()["storage_reason"] == LOCKED.message
        assert lab.view(view["id"])["notes"] == []
        other.execute("ROLLBACK")
    lab.command(view, "note", text="hello")
    assert lab.context.storage.state().status == "ok"
    assert len(lab.context.storage.take_outages()) == 1


def test_a_commit_that_changes_nothing_does_not_count_as_success(
    small_lab: tuple[Lab, Path],
) -> None:
    """A commit without changes does not end a storage failure."""
    lab, _ = small_lab
    lab.context.storage.failed(refusal(sqlite3.SQLITE_FULL))
    with lab.database.writing() as db:
        db.connection().exec_driver_sql("SELECT 1")
    with lab.database.writing():
        pass
    assert lab.context.storage.state().status == "failing"
    with lab.database.writing() as db:
        db.connection().exec_driver_sql("UPDATE studies SET key = key")
    assert lab.context.storage.state().status == "ok"


def test_a_damaged_database_is_reported_as_such(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    """A damaged database is reported as such, not as an unknown error."""
    origin: Any = sqlite3.DatabaseError("database disk image is malformed")
    origin.sqlite_errorcode = sqlite3.SQLITE_CORRUPT

    def fail(_: object) -> Iterator[None]:
        raise DatabaseError("SELECT", {}, origin)

    monkeypatch.setattr(type(lab.database), "reading", fail)
    problem = error(lab.stranger().get("/api/health"), 503, "not_durable")
    assert DAMAGED.message in problem["message"]
