"""Tests of writes that wait for the same turn: they share a commit, and nothing else."""

import asyncio
import sqlite3
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest
from sqlalchemy import event, text
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from app.database import Database, after_commit, open_database
from app.errors import NotNow

INSERT = text("INSERT INTO note (name) VALUES (:name)")
Work = Callable[[Session], Any]


@pytest.fixture
def database(sqlite_url: str) -> Iterator[Database]:
    """Provide a database with an empty table of names."""
    opened = open_database(sqlite_url)
    with opened.writing() as db:
        db.execute(text("CREATE TABLE note (name TEXT PRIMARY KEY)"))
    yield opened
    opened.close()


def noted(name: str) -> Work:
    """Return a write that stores a name and returns it."""

    def work(db: Session) -> str:
        db.execute(INSERT, {"name": name})
        return name

    return work


def together(database: Database, works: Sequence[Work]) -> list[Any]:
    """Let writes wait until all of them do; return their results or errors."""

    async def run() -> list[Any]:
        with database.write_turn():
            waiting = [asyncio.create_task(database.write(work)) for work in works]
            await asyncio.sleep(0.05)
        return await asyncio.gather(*waiting, return_exceptions=True)

    return asyncio.run(run())


def names(database: Database) -> list[str]:
    """Return the stored names in alphabetical order."""
    with database.reading() as db:
        return list(db.scalars(text("SELECT name FROM note ORDER BY name")))


def test_writes_that_wait_share_one_commit(database: Database) -> None:
    """Sixteen writes that wait for the same turn are stored by one commit."""
    before = database.commits.number
    wanted = [f"{number:02}" for number in range(16)]
    assert together(database, [noted(name) for name in wanted]) == wanted
    assert names(database) == wanted
    assert database.commits.number - before == 1


def test_a_refused_write_is_undone_alone(database: Database) -> None:
    """A write that raises leaves nothing behind, and those that share its commit are stored."""

    def refuses(db: Session) -> None:
        db.execute(INSERT, {"name": "half-made"})
        raise NotNow("not now", value=1, valid=2, remedy="wait")

    found = together(database, [noted("first"), noted("a"), refuses, noted("b")])
    assert [type(one) for one in found] == [str, str, NotNow, str]
    assert names(database) == ["a", "b", "first"]


def test_what_the_database_refuses_fails_alone(database: Database) -> None:
    """A write that violates a constraint fails, and each of the others is stored once."""
    found = together(database, [noted("first"), noted("a"), noted("first"), noted("b")])
    assert [isinstance(one, Exception) for one in found] == [False, False, True, False]
    assert names(database) == ["a", "b", "first"]


def test_nothing_is_published_before_the_shared_commit(database: Database) -> None:
    """What has to follow a commit runs after the commit of the whole batch, and once."""
    seen: list[str] = []
    event.listen(database.engine, "commit", lambda _: seen.append("commit"))

    def published(name: str) -> Work:
        def work(db: Session) -> None:
            db.execute(INSERT, {"name": name})
            after_commit(db, lambda: seen.append(name))

        return work

    together(database, [published("a"), published("b")])
    assert seen == ["commit", "a", "b"]


def test_a_failed_shared_commit_acknowledges_nothing(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If no commit reaches the disk, every write that shared it fails and nothing is published."""
    seen: list[str] = []

    def full(_: object) -> None:
        raise sqlite3.OperationalError("database or disk is full")

    def work(db: Session) -> None:
        db.execute(INSERT, {"name": "a"})
        after_commit(db, lambda: seen.append("published"))

    monkeypatch.setattr(database.engine.dialect, "do_commit", full)
    found = together(database, [work, work, work])
    monkeypatch.undo()
    assert [type(one) for one in found] == [OperationalError] * 3
    assert (seen, names(database)) == ([], [])
