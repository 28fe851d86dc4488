"""Tests of withdrawal and erasure with the real server: no byte of the participant remains.

Fault 30 of the matrix, and from fault 29 that a restored backup does not undo an erasure. The test
searches for canaries: every answer, note, reason and name of the participant contains their code,
and every frame contains two numbers that occur nowhere else. It searches the tables, every file of
the data folder, the server's log, and a new export and a new backup.
"""

import shutil
import sqlite3
import time
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest
from sqlalchemy import func, select

from app.database import open_database
from app.features.record.sessions.journal import events_of, verify_chain
from app.models import TelemetryBatch
from app.platform.access import session_by_id
from tests.faults.commands import reembody
from tests.faults.figures import note
from tests.features.care.rights.visit import (
    Visit,
    erase,
    in_bytes,
    in_files,
    in_tables,
    make_visit,
    participant_of,
)
from tests.features.lab import STUDY, ok
from tests.features.record.headset.site import Site
from tests.support.postgres import fresh_postgres
from tests.support.server import ADMIN_PASSWORD, LiveServer
from tests.wire.samples import message, standing

CREDENTIALS = {"username": "admin", "password": ADMIN_PASSWORD}
DATABASE = "reembody.sqlite"


@contextmanager
def installed(folder: Path, engine: str) -> Iterator[Site]:
    """Yield a running server on the named engine, with its operator signed in."""
    if engine == "sqlite":
        url = f"sqlite:///{folder / 'data' / DATABASE}"
        with LiveServer(folder) as server, signed_in(server, url) as site:
            yield site
        return
    with fresh_postgres() as url:
        server = LiveServer(folder, environment={"REEMBODY_DATABASE_URL": url})
        with server, signed_in(server, url) as site:
            yield site


@contextmanager
def signed_in(server: LiveServer, url: str) -> Iterator[Site]:
    """Yield a site with a signed-in operator and direct access to the database."""
    with server.client() as operator:
        ok(operator.post("/api/login", json=CREDENTIALS))
        database = open_database(url)
        try:
            yield Site(server, operator, database)
        finally:
            database.close()


@dataclass(frozen=True)
class Search:
    """A search of everything that the product stores or exports for one visit."""

    site: Site
    visit: Visit
    elsewhere: Path

    def residuals(self) -> int:
        """Return the number of matches in tables, files, the log, a new export and a new backup."""
        return (
            sum(in_tables(self.visit, self.site.database.engine).values())
            + sum(self.files().values())
            + self.in_new_copies()
        )

    def files(self) -> dict[str, int]:
        """Return the matches in the data folder, its write-ahead log and the server's log."""
        folder = self.site.server.data_dir
        return in_files(self.visit, [*folder.rglob("*"), self.site.server._log_file])

    def in_new_copies(self) -> int:
        """Return the matches in a new export of everything and in a new backup."""
        answer = self.site.operator.get(f"/api/studies/{STUDY}/export?kind=all")
        assert answer.is_success
        to = self.elsewhere / f"{len(list(self.elsewhere.iterdir()))}.reembody"
        assert reembody(self.site.server, "backup", to).code == 0
        return in_bytes(self.visit, answer.content) + in_bytes(self.visit, to.read_bytes())


@pytest.fixture
def elsewhere(tmp_path: Path) -> Path:
    """Provide a folder for backups that is outside the server's folder."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    return folder


def refused_after_withdrawal(site: Site, visit: Visit) -> int:
    """Withdraw while the headset is connected; return how many later frames were stored."""
    with site.headset(visit.headset_token) as headset:
        site.command(visit.session_id, "withdraw", reason=f"{visit.code} feels sick")
        headset.hear("state", lambda told: told["status"] == "withdrawn")
        headset.say(message(standing(9), epoch=headset.epoch, seq_first=0))
        assert headset.hear("error")["code"] == "withdrawn"
    streams = ok(site.operator.get(f"/api/sessions/{visit.session_id}/streams"))
    return sum(one["frames_stored"] for one in streams if one["epoch"] == headset.epoch)


def settled(site: Site, visit: Visit, within_s: float = 60.0) -> Mapping[str, int]:
    """Return the places of a visit's data after its last batches were folded into chunks."""
    give_up_s = time.monotonic() + within_s
    waiting = select(func.count()).where(TelemetryBatch.session_id == visit.session_id)
    while True:
        with site.database.reading() as db:
            if not db.scalar(waiting):
                break
        assert time.monotonic() < give_up_s, "batches were not folded"
        time.sleep(0.1)
    found = in_tables(visit, site.database.engine)
    assert "telemetry_batches.message" not in found
    return found


@pytest.mark.parametrize("engine", ["sqlite", "postgresql"])
def test_no_byte_of_an_erased_participant_is_left(
    tmp_path: Path, elsewhere: Path, engine: str
) -> None:
    """No table, file or copy contains a byte of an erased participant, and others are unchanged.

    Recording stops, and the remaining event log verifies.
    """
    with installed(tmp_path / "live", engine) as site:
        visit, other = make_visit(site), make_visit(site, "P-0815")
        search, others = Search(site, visit, elsewhere), Search(site, other, elsewhere)
        before = search.residuals()
        taken = refused_after_withdrawal(site, visit)
        site.command(other.session_id, "abort", reason="the headset failed")
        untouched = settled(site, other)
        erased = erase(site, visit, "withdrawn")
        assert erased["overwritten"]
        residuals = search.residuals()
        assert before > 0
        assert (taken, residuals) == (0, 0), search.files()
        assert in_tables(other, site.database.engine).keys() >= untouched.keys()
        assert others.residuals() > 0
        with site.database.reading() as db:
            session = session_by_id(db, visit.session_id)
            assert verify_chain(events_of(db, session.id), version=session.version).ok
        site.server.kill()
        assert search.files() == {}
        site.server.start()
    note(30, f"withdrawal, erasure ({engine})", "canaries before the erasure", before)
    note(30, f"withdrawal, erasure ({engine})", "frames taken after the withdrawal", taken)
    note(30, f"withdrawal, erasure ({engine})", "canary residuals", residuals)


def test_pending_overwriting_is_done_at_the_next_start(tmp_path: Path, elsewhere: Path) -> None:
    """Data that cannot be overwritten while a session runs are overwritten at the next start.

    The database file is not rewritten during the other session, and the pending work survives a
    crash.
    """
    with installed(tmp_path / "live", "sqlite") as site:
        visit, other = make_visit(site), make_visit(site, "P-0815")
        site.command(visit.session_id, "withdraw", reason="enough")
        assert erase(site, visit)["overwritten"] is False
        assert in_tables(visit, site.database.engine) == {}
        site.server.kill()
        site.server.start()
        ok(site.operator.post("/api/login", json=CREDENTIALS))
        assert participant_of(site, visit.session_id)["erasure"]["overwritten"]
        assert Search(site, visit, elsewhere).residuals() == 0
        assert site.view(other.session_id)["status"] == "active"


@pytest.mark.parametrize("engine", ["sqlite", pytest.param("postgresql", marks=pytest.mark.long)])
def test_a_restored_backup_does_not_undo_an_erasure(
    tmp_path: Path, elsewhere: Path, engine: str
) -> None:
    """A restored backup does not undo an erasure, in the same installation or a new one.

    The new installation has only the list of erasures.
    """
    backup = elsewhere / "older.reembody"
    with installed(tmp_path / "live", engine) as site:
        visit, other = make_visit(site), make_visit(site, "P-0815")
        site.command(other.session_id, "abort", reason="the headset failed")
        assert reembody(site.server, "backup", backup).code == 0
        site.command(visit.session_id, "withdraw", reason="enough")
        erased = erase(site, visit)
        assert [one["place"] for one in erased["remaining"]] == [str(backup)]
        site.server.stop()
        said = reembody(site.server, "restore", backup, "--replace", "--json").json
        site.server.start()
        ok(site.operator.post("/api/login", json=CREDENTIALS))
        search = Search(site, visit, elsewhere)
        residuals = search.residuals()
        assert (said["erasures_reapplied"], residuals) == (1, 0), search.files()
        assert participant_of(site, visit.session_id)["erasure"]["id"] == erased["id"]
        assert site.view(visit.session_id)["status"] == "withdrawn"
        assert in_tables(other, site.database.engine)
        listed = site.server.data_dir / "erasures.jsonl"
        kept = elsewhere / "erasures.jsonl"
        shutil.copyfile(listed, kept)
    moved = in_a_new_installation(tmp_path / "new", visit, backup, kept)
    assert moved == 0
    note(29, f"restore behind an erasure ({engine})", "erasures reapplied", 1)
    note(29, f"restore behind an erasure ({engine})", "canary residuals", residuals + moved)


def in_a_new_installation(folder: Path, visit: Visit, backup: Path, listed: Path) -> int:
    """Restore a backup where only the list of erasures exists; return the residuals."""
    server = LiveServer(folder)
    server.data_dir.mkdir(parents=True)
    shutil.copyfile(listed, server.data_dir / listed.name)
    said = reembody(server, "restore", backup, "--json").json
    assert said["erasures_reapplied"] == 1
    return sum(in_files(visit, server.data_dir.rglob("*")).values())


def test_an_older_database_file_is_erased_at_the_start(tmp_path: Path) -> None:
    """The start repeats past erasures on an older database file that was copied into place."""
    older = tmp_path / "older.sqlite"
    with installed(tmp_path / "live", "sqlite") as site:
        visit = make_visit(site)
        site.command(visit.session_id, "withdraw", reason="enough")
        with (
            closing(sqlite3.connect(site.server.data_dir / DATABASE)) as now,
            closing(sqlite3.connect(older)) as copy,
        ):
            now.backup(copy)
        erase(site, visit)
        site.server.stop()
        site.database.close()
        for file in site.server.data_dir.glob(f"{DATABASE}*"):
            file.unlink()
        shutil.copyfile(older, site.server.data_dir / DATABASE)
        assert in_files(visit, site.server.data_dir.iterdir())
        site.server.start()
        assert in_files(visit, site.server.data_dir.rglob("*")) == {}
        assert "made again" in site.server.log


def test_a_lost_list_of_erasures_is_rebuilt(tmp_path: Path) -> None:
    """A lost list of erasures is rebuilt from the table at every start, and contains only ids."""
    with installed(tmp_path / "live", "sqlite") as site:
        visit = make_visit(site)
        site.command(visit.session_id, "withdraw", reason="enough")
        erase(site, visit)
        listed = site.server.data_dir / "erasures.jsonl"
        first = listed.read_text()
        listed.unlink()
        site.server.restart()
        assert listed.read_text() == first
        assert visit.session_id in first
        assert visit.code not in first
