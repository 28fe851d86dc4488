"""The head of the audit trail, kept outside, shows that the trail's end was cut or written anew."""

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
    """The database of this machine, with a study and three entries in its trail."""
    monkeypatch.setenv("REEMBODY_DATABASE_URL", database_url)
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
    append(database, 3)
    yield database
    database.close()


def append(database: Database, entries: int) -> str:
    """Put more on the trail; its head behind them."""
    for _ in range(entries):
        with database.writing() as db:
            record(db, actor="account:admin", action="test.done", now=NOW)
    with database.reading() as db:
        return str(head_of(db))


def cut(database: Database, last: int) -> None:
    """Remove everything behind `last`, and set the head back, as a forger would."""
    with database.writing() as db:
        db.execute(delete(AuditEntry).where(AuditEntry.seq > last))
        left = db.get_one(AuditEntry, last)
        db.execute(update(AuditHead).values(seq=last, hash=left.hash))


def test_a_head_is_found_while_the_trail_grows(database: Database) -> None:
    """The trail of then is the beginning of the trail of now."""
    head = append(database, 0)
    append(database, 4)
    found = VERIFY.figures("--head", head)["audit"]
    assert found["ok"]
    assert (found["entries"], found["heads"]) == (7, [{"head": head, "found": True}])


def test_a_cut_tail_is_found_with_a_head_from_outside(database: Database) -> None:
    """What is left verifies by itself, and only the head that was kept elsewhere tells."""
    early, late = append(database, 0), append(database, 2)
    cut(database, 4)
    assert VERIFY.run().exit_code == 0
    assert VERIFY.run("--head", early).exit_code == 0
    result = VERIFY.run("--head", early, "--head", late)
    assert result.exit_code == 1
    assert f"Head {late} is not in it" in result.stdout


def test_a_trail_that_was_written_anew_is_found(database: Database) -> None:
    """As many entries as before, but others."""
    head = append(database, 2)
    cut(database, 3)
    with database.writing() as db:
        for _ in range(2):
            record(db, actor="account:admin", action="test.other", now=NOW)
    assert VERIFY.run().exit_code == 0
    assert VERIFY.run("--head", head).exit_code == 1


def test_an_entry_that_was_changed_is_named_without_a_session(database: Database) -> None:
    """The trail is checked where no session is named."""
    with database.writing() as db:
        db.execute(update(AuditEntry).where(AuditEntry.seq == 2).values(action="test.changed"))
    result = VERIFY.run()
    assert result.exit_code == 1
    assert "entry 2 was changed or removed" in result.stdout


def test_backup_and_export_print_the_head(database: Database, tmp_path: Path) -> None:
    """Each as it was when it was made, though to put them on record may lengthen the trail."""
    head = append(database, 0)
    assert export_to_folder(STUDY, tmp_path / "out", Activity("")).endswith(f"audit head {head}")
    made = Invoked("backup").run(tmp_path / "a.reembody")
    assert f"audit head {head}" in made.stdout
    made = Invoked("backup").run(tmp_path / "b.reembody", "--json")
    assert VERIFY.figures("--head", json.loads(made.stdout)["audit_head"])["audit"]["ok"]


@pytest.mark.one_engine
@pytest.mark.usefixtures("database")
@pytest.mark.parametrize("text", ["", "3", "3:", "3:abc", "x:" + 64 * "0", "3:" + 65 * "0"])
def test_what_is_no_head_is_refused_with_how_one_looks(text: str) -> None:
    """Also one that was copied incompletely."""
    assert "SEQ:HASH" in VERIFY.refusal("--head", text)


def test_a_head_is_read_as_it_is_written() -> None:
    """With spaces around it, in capitals, and shortened to what may be typed from paper."""
    head = TrailHead(12, "ab" * 32)
    assert TrailHead.parse(f" {head}\n") == TrailHead.parse(str(head).upper()) == head
    assert TrailHead.parse(f"12:{head.hash[:16]}").hash == head.hash[:16]
    with pytest.raises(InvalidInput):
        TrailHead.parse(f"12:{head.hash[:15]}")


def test_the_head_of_an_empty_trail_is_in_every_trail(database: Database) -> None:
    """An export from before the first entry proves nothing, and is not taken for a forgery."""
    assert VERIFY.figures("--head", f"0:{FIRST_HASH}")["audit"]["ok"]
    assert append(database, 0).startswith("3:")
