"""Tests that a head of the audit trail stored elsewhere reveals a cut or rewritten trail."""

import json
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import delete, update

from app.cli.progress import Activity
from app.cli.record import export_to_folder
from app.database import Database, open_database
from app.errors import InvalidInput
from app.features.people.audit import TrailHead, head_of, record
from app.features.people.audit.service import FIRST_HASH
from app.models import AuditEntry, AuditHead
from tests.cli.invoked import Invoked
from tests.features.builders import STUDY, build_study

VERIFY = Invoked("verify")
NOW = datetime(2026, 5, 4, 12, tzinfo=UTC)


@pytest.fixture
def database(database_url: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Database]:
    """Yield the configured database, with a study and three entries in its audit trail."""
    monkeypatch.setenv("REEMBODY_DATABASE_URL", database_url)
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
    append(database, 3)
    yield database
    database.close()


def append(database: Database, entries: int) -> str:
    """Append entries to the audit trail and return its head."""
    for _ in range(entries):
        with database.writing() as db:
            record(db, actor="account:admin", action="test.done", now=NOW)
    with database.reading() as db:
        return str(head_of(db))


def cut(database: Database, last: int) -> None:
    """Delete all entries after `last` and reset the head, as a forger would."""
    with database.writing() as db:
        db.execute(delete(AuditEntry).where(AuditEntry.seq > last))
        left = db.get_one(AuditEntry, last)
        db.execute(update(AuditHead).values(seq=last, hash=left.hash))


def test_a_head_is_found_while_the_trail_grows(database: Database) -> None:
    """An earlier head is still found in an audit trail that has grown since."""
    head = append(database, 0)
    append(database, 4)
    found = VERIFY.figures("--head", head)["audit"]
    assert found["ok"]
    assert (found["entries"], found["heads"]) == (7, [{"head": head, "found": True}])


def test_a_truncated_trail_is_detected_by_a_later_head(database: Database) -> None:
    """A truncated audit trail is consistent, but fails to verify against a head that it lost."""
    early, late = append(database, 0), append(database, 2)
    cut(database, 4)
    assert VERIFY.run().exit_code == 0
    assert VERIFY.run("--head", early).exit_code == 0
    result = VERIFY.run("--head", early, "--head", late)
    assert result.exit_code == 1
    assert f"Head {late} is not in it" in result.stdout


def test_a_rewritten_trail_is_detected_by_a_head(database: Database) -> None:
    """An audit trail whose last entries were rewritten does not verify against an earlier head."""
    head = append(database, 2)
    cut(database, 3)
    with database.writing() as db:
        for _ in range(2):
            record(db, actor="account:admin", action="test.other", now=NOW)
    assert VERIFY.run().exit_code == 0
    assert VERIFY.run("--head", head).exit_code == 1


def test_verify_reports_a_changed_audit_entry(database: Database) -> None:
    """The command `verify` without a session reports a changed entry of the audit trail."""
    with database.writing() as db:
        db.execute(update(AuditEntry).where(AuditEntry.seq == 2).values(action="test.changed"))
    result = VERIFY.run()
    assert result.exit_code == 1
    assert "entry 2 was changed or removed" in result.stdout


def test_backup_and_export_print_the_head(database: Database, tmp_path: Path) -> None:
    """Export and backup print the head of the audit trail as of their snapshot."""
    head = append(database, 0)
    assert export_to_folder(STUDY, tmp_path / "out", Activity("")).endswith(f"audit head {head}")
    made = Invoked("backup").run(tmp_path / "a.reembody")
    assert f"audit head {head}" in made.stdout
    made = Invoked("backup").run(tmp_path / "b.reembody", "--json")
    assert VERIFY.figures("--head", json.loads(made.stdout)["audit_head"])["audit"]["ok"]


@pytest.mark.one_engine
@pytest.mark.usefixtures("database")
@pytest.mark.parametrize("text", ["", "3", "3:", "3:abc", "x:" + 64 * "0", "3:" + 65 * "0"])
def test_an_invalid_head_is_refused_with_its_format(text: str) -> None:
    """An invalid or incomplete head is refused, and the expected format is shown."""
    assert "SEQ:HASH" in VERIFY.refusal("--head", text)


def test_a_head_is_parsed_leniently() -> None:
    """A head may have spaces around it, capital letters, or only 16 digits of its hash."""
    head = TrailHead(12, "ab" * 32)
    assert TrailHead.parse(f" {head}\n") == TrailHead.parse(str(head).upper()) == head
    assert TrailHead.parse(f"12:{head.hash[:16]}").hash == head.hash[:16]
    with pytest.raises(InvalidInput):
        TrailHead.parse(f"12:{head.hash[:15]}")


def test_the_head_of_an_empty_trail_is_in_every_trail(database: Database) -> None:
    """The head of an empty audit trail is found in every trail."""
    assert VERIFY.figures("--head", f"0:{FIRST_HASH}")["audit"]["ok"]
    assert append(database, 0).startswith("3:")
