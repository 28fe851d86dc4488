"""Tests that a backup's content is validated before it is restored, even if its checksums match."""

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from datetime import timedelta
from pathlib import Path

import pytest
from sqlalchemy import column, select, table, text

from app.database import Database, open_database
from app.errors import InvalidInput
from app.features.care.backups import Lifetimes, RestoredContent
from app.features.care.backups.manifest import Manifest, read_manifest
from app.features.care.backups.manifest import write_manifest as seal
from app.features.care.backups.reading import digests, opened_copy
from app.features.care.backups.shapes import MANIFEST_TABLE, shapes_of
from app.models import StudySession
from tests.features.care.backups.lab import NOW, make, put_back
from tests.features.lab import PASSWORD, Lab, ok, running_lab
from tests.support.filled import contents
from tests.support.sqlite import fresh_sqlite

pytestmark = pytest.mark.thorough


def forged(path: Path, *statements: str) -> Path:
    """Change a backup with SQL statements and recompute all its checksums, so that they match."""
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA ignore_check_constraints=ON")
        for statement in statements:
            connection.execute(statement)
        connection.commit()
        before = read_manifest(connection)
    with opened_copy(path) as copy:
        tables = digests(copy, shapes_of(copy))
    with closing(sqlite3.connect(path)) as connection:
        connection.execute(f"DROP TABLE {MANIFEST_TABLE}")
        after = Manifest(
            before.made_at, before.product_version, before.revision, before.engine, tables
        )
        seal(connection, after)
        connection.commit()
        connection.execute("VACUUM")
    return path


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("CREATE TABLE more (x INTEGER PRIMARY KEY)", "the table more is unknown to this program"),
        ("ALTER TABLE accounts ADD COLUMN more TEXT", "column accounts.more is unknown to this"),
        (
            """ALTER TABLE accounts ADD COLUMN "id"", ""role" TEXT""",
            'column accounts.id", "role is unknown to this',
        ),
        ("ALTER TABLE accounts RENAME COLUMN role TO rolf", "no column accounts.role"),
        ("CREATE VIEW seen AS SELECT 1", "there is a view seen"),
        (
            "CREATE TRIGGER after DELETE ON scores BEGIN DELETE FROM answers; END",
            "there is a trigger after",
        ),
        ("UPDATE accounts SET created_at = 'once'", "accounts.created_at has values other"),
        ("UPDATE accounts SET role = x'00ff'", "accounts.role has values other"),
        ("UPDATE study_versions SET instruments = '{'", "study_versions.instruments has"),
        ("UPDATE sessions SET study_id = 'nobody'", "refer to nothing"),
    ],
)
def test_unknown_tables_and_invalid_values_are_refused(
    sqlite: Database, tmp_path: Path, statement: str, message: str
) -> None:
    """A backup with unknown tables, columns, views, triggers or invalid values is not restored."""
    make(sqlite, tmp_path / "all.reembody")
    before = contents(sqlite.engine)
    with pytest.raises(InvalidInput, match=message):
        put_back(sqlite, forged(tmp_path / "all.reembody", statement), replace=True)
    assert contents(sqlite.engine) == before
    assert not (tmp_path / "kept").exists()


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Lab]:
    """Yield an installation with an active session whose event chain verifies."""
    (tmp_path / "lab").mkdir()
    with running_lab(fresh_sqlite(tmp_path / "lab" / "reembody.sqlite")) as running:
        credentials = {"username": "admin", "password": PASSWORD}
        ok(running.operator.post("/api/login", json=credentials))
        running.command(running.join(participant_code="P-014"), "start")
        yield running


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("UPDATE accounts SET role = 'superadmin'", "role 'superadmin'"),
        ("UPDATE session_events SET actor = 'nobody' WHERE seq = 1", "chain of session"),
        ("DELETE FROM session_events WHERE seq = (SELECT max(seq) FROM session_events)", "session"),
        ("UPDATE audit_head SET seq = seq + 1", "the audit trail"),
    ],
)
def test_unknown_roles_and_broken_chains_are_refused(
    lab: Lab, database_url: str, tmp_path: Path, statement: str, message: str
) -> None:
    """A backup with an unknown role or a broken chain is refused on both engines.

    A broken chain is accepted with `even_though_altered`; an unknown role never is.
    """
    make(lab.database, tmp_path / "all.reembody")
    backup = forged(tmp_path / "all.reembody", statement)
    target = open_database(database_url)
    options = {"even_though_active": True, "replace": True}
    with pytest.raises(InvalidInput, match=message):
        put_back(target, backup, content=RestoredContent(), **options)
    with target.reading() as db:
        assert db.scalar(text("SELECT count(*) FROM accounts")) == 0
    if "role" not in message:
        put_back(target, backup, content=RestoredContent(even_though_altered=True), **options)
        with target.reading() as db:
            assert db.scalar(text("SELECT count(*) FROM accounts")) == 1
    target.close()


def test_an_intact_record_is_restored(lab: Lab, database_url: str, tmp_path: Path) -> None:
    """A backup of a real installation passes the check of its content on both engines."""
    make(lab.database, tmp_path / "all.reembody")
    target = open_database(database_url)
    done = put_back(
        target, tmp_path / "all.reembody", content=RestoredContent(), even_though_active=True
    )
    assert done.rows > 0
    target.close()


def test_a_failed_restore_deletes_its_safety_backup(lab: Lab, tmp_path: Path) -> None:
    """A restore that fails deletes its own safety backup, since no data were replaced."""
    make(lab.database, tmp_path / "all.reembody")
    forged(tmp_path / "all.reembody", "UPDATE accounts SET role = 'superadmin'")
    with pytest.raises(InvalidInput):
        put_back(
            lab.database,
            tmp_path / "all.reembody",
            content=RestoredContent(),
            replace=True,
            even_though_active=True,
        )
    assert list((tmp_path / "kept").iterdir()) == []


ALTERED_LOG, ALTERED_HASH = "not what its log leads to", "not the hash of its canonical_json"
ONLY_ALTERED = (ALTERED_LOG, ALTERED_HASH)
LIES = {
    "an unreadable snapshot": (
        "UPDATE sessions SET snapshot = '{}'",
        r"sessions \w{32} has the snapshot {}, which cannot be read",
    ),
    "a snapshot of another moment": (
        "UPDATE sessions SET snapshot = json_set(snapshot, '$.current', 1)",
        ALTERED_LOG,
    ),
    "a snapshot of fewer steps": (
        "UPDATE sessions SET snapshot = json_remove(snapshot, '$.steps[0]')",
        "not of the [0-9]+ steps of its plan",
    ),
    "an unknown status": (
        "UPDATE sessions SET status = 'flying'",
        "has the status 'flying', not one of planned, active",
    ),
    "a status that the log contradicts": (
        "UPDATE sessions SET status = 'completed'",
        "not of completed and version 1",
    ),
    "a status on which snapshot and log differ": (
        "UPDATE sessions SET status='planned', snapshot=json_set(snapshot,'$.status','planned')",
        ALTERED_LOG,
    ),
    "a language that the study does not have": ("UPDATE sessions SET language = 'xx'", "no texts"),
    "a clock that runs backwards": ("UPDATE sessions SET time_scale = -1", "time_scale = 1.0"),
    "unreadable shortfalls": (
        "UPDATE sessions SET shortfalls = '[5]'",
        r"the shortfalls \[5\], which cannot be read",
    ),
    "a session without a slot": ("DELETE FROM slot_attempts", "study_version_id"),
    "an unreadable study": (
        "UPDATE study_versions SET canonical_json = '{}'",
        r"study_versions \w{32} has the canonical_json '{}', which cannot be read",
    ),
    "a study whose hash is another's": (
        "UPDATE study_versions SET content_hash = substr(content_hash, 2) || 'g'",
        ALTERED_HASH,
    ),
    "a version without its wordings": (
        "UPDATE study_versions SET instruments = '{}'",
        "names no stored wording",
    ),
    "wordings as a list": (
        "UPDATE study_versions SET instruments = '[]'",
        r"the instruments \[\], not an object",
    ),
    "a version number out of range": (
        "UPDATE study_versions SET number = 9223372036854775807",
        "number is out of range",
    ),
    "a version after a gap": ("UPDATE study_versions SET number = 7", "not numbered from 1 on"),
    "a key that is a path": ("UPDATE studies SET key = '../../x'", r"the key '../../x', not"),
    "an unreadable instrument": (
        "UPDATE instrument_versions SET canonical_json = '[]'",
        r"canonical_json '\[\]', which cannot be read",
    ),
    "an order of one condition": (
        """UPDATE ledger_slots SET sequence = '["latency_9"]'""",
        r"ledger_slots \w{32} has the sequence \['latency_9'\], not each of",
    ),
    "an order that is a number": (
        "UPDATE ledger_slots SET sequence = '5'",
        "the sequence 5, not a list",
    ),
    "an order of lists": ("UPDATE ledger_slots SET sequence = '[[],{}]'", "the sequence"),
    "ledger blocks that do not exist": ("UPDATE ledgers SET blocks = blocks + 1", "ledgers"),
    "a design of no study": ("UPDATE ledgers SET design_hash = 'x'", "the design of no version"),
    "an unreadable avatar": ("UPDATE avatar_versions SET canonical_json = '{}'", "avatar_versi"),
    "a NUL in a name": (
        "UPDATE accounts SET username = 'op' || char(0) || 'x'",
        "username holds a NUL character",
    ),
    "an invalid user name": ("UPDATE accounts SET username = '../x'", "no user name"),
    "an invalid password hash": (
        "UPDATE accounts SET password_hash = 'x'",
        "no hash of a password",
    ),
    "a password's hash of four gigabytes": (
        "UPDATE accounts SET password_hash = replace(password_hash, 'm=', 'm=42949')",
        "no hash of a password",
    ),
    "a login that never expires": (
        "UPDATE login_tokens SET expires_at = '9999-12-31 23:59:59.999999'",
        "expires_at is outside 1970 to 2199",
    ),
    "a login with an unknown purpose": ("UPDATE login_tokens SET purpose = 'all'", "purpose 'all'"),
    "a participant of an unknown kind": ("UPDATE participants SET kind = 'gods'", "kind 'gods'"),
    "a participant with a name": ("UPDATE participants SET code = 'Eva Maier'", "no code of a"),
}


@pytest.fixture(scope="module")
def backed_up(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Database, Path]]:
    """Yield an installation with an active session, and a backup of it; tests change neither."""
    folder = tmp_path_factory.mktemp("lies")
    with running_lab(fresh_sqlite(folder / "reembody.sqlite"), data_dir=folder) as running:
        ok(running.operator.post("/api/login", json={"username": "admin", "password": PASSWORD}))
        running.command(running.join(participant_code="P-014"), "start")
        make(running.database, folder / "all.reembody")
        yield running.database, folder / "all.reembody"


@pytest.mark.parametrize("lie", LIES)
def test_content_that_this_program_cannot_have_written_is_refused(
    backed_up: tuple[Database, Path], tmp_path: Path, lie: str
) -> None:
    """A backup whose content this program cannot have written is refused, and no row changes.

    Its checksums match. The error names table, row and value. Content that cannot be read is
    refused even where an altered record is accepted.
    """
    statement, message = LIES[lie]
    database, whole = backed_up
    backup = forged(Path(shutil.copy(whole, tmp_path)), statement)
    before = contents(database.engine)
    for even_though_altered in [False] if message in ONLY_ALTERED else [False, True]:
        with pytest.raises(InvalidInput, match=message) as refused:
            put_back(
                database,
                backup,
                content=RestoredContent(even_though_altered),
                replace=True,
                even_though_active=True,
            )
        assert "othing was changed" in str(refused.value)
        assert contents(database.engine) == before
    assert not list(tmp_path.glob("kept/*"))


def test_restored_credentials_expire_no_later_than_new_ones(lab: Lab, tmp_path: Path) -> None:
    """Restored logins, pairing codes and invitations expire no later than ones issued now."""
    with lab.database.reading() as db:
        session_id = db.scalar(select(StudySession.id))
    ok(lab.operator.post(f"/api/sessions/{session_id}/pairings", json={"device": "tablet"}))
    ok(lab.operator.post("/api/invitations", json={"role": "operator"}))
    make(lab.database, tmp_path / "all.reembody")
    tables = ("login_tokens", "pairing_codes", "invitations")
    later = [f"UPDATE {name} SET expires_at = '2036-01-01 00:00:00.000000'" for name in tables]  # noqa: S608 - named above
    backup = forged(tmp_path / "all.reembody", *later)
    lifetimes = Lifetimes(NOW, login=timedelta(hours=12), pairing=timedelta(minutes=10))
    options = {"even_though_active": True, "replace": True}
    put_back(lab.database, backup, content=RestoredContent(lifetimes=lifetimes), **options)
    with lab.database.reading() as db:
        ends: list[set[object]] = [
            set(db.scalars(select(table(name, column("expires_at"))))) for name in tables
        ]
    assert ends == [
        {"2026-11-21 18:11:08.123456"},
        {"2026-11-21 06:21:08.123456"},
        {"2026-12-21 06:11:08.123456"},
    ]
