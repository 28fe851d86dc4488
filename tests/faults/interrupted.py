"""Interrupt a migration at any point, and read which schema is left."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from alembic import command
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, String, column, event, inspect, select, table

from app.database import open_database
from app.schema_revisions import alembic_config
from tests.support.filled import VERSION_TABLE, contents_by, remembered, statements_of

READING = {"SELECT", "PRAGMA", "SHOW", "SET", "BEGIN"}
Step = tuple[str, str]
"""The revision before and after a migration step."""


class Interrupted(Exception):
    """Raised to stop a migration at a chosen point."""


@dataclass(frozen=True)
class Found:
    """The state of a database: its revision, a description of its schema, its tables' contents."""

    revision: str | None
    schema: dict[str, Any]
    contents: dict[str, list[dict[str, Any]]]


def steps() -> list[Step]:
    """Return every migration step, oldest first; the revision `base` is an empty database."""
    script = ScriptDirectory.from_config(alembic_config("sqlite://"))
    newest_first = [revision.revision for revision in script.walk_revisions()]
    revisions = ["base", *reversed(newest_first)]
    return list(pairwise(revisions))


def upgrade(url: str, revision: str) -> None:
    """Migrate a database to a revision in the same way as the product."""
    if revision != "base":
        command.upgrade(alembic_config(url), revision)


def found(url: str) -> Found:
    """Read the revision, schema and contents of a database."""
    database = open_database(url)
    try:
        with database.engine.connect() as connection:
            statements = statements_of(connection)
            schema = _remembered_words(statements, connection)
            version = select(column("version_num", String)).select_from(table(VERSION_TABLE))
            revision = connection.scalar(version) if VERSION_TABLE in schema else None
            rows = contents_by(statements, connection)
        words = {name: told for name, told in schema.items() if name != VERSION_TABLE}
        return Found(revision, words, rows)
    finally:
        database.close()


def _in_words(connection: Connection) -> dict[str, Any]:
    """Describe all tables with one query of each kind.

    PostgreSQL answers a query about fifty tables as fast as a query about one.
    """
    look = inspect(connection)
    columns, keys = look.get_multi_columns(), look.get_multi_pk_constraint()
    references, unique = look.get_multi_foreign_keys(), look.get_multi_unique_constraints()
    checks, indices = look.get_multi_check_constraints(), look.get_multi_indexes()
    return {
        name: {
            "columns": [{**one, "type": str(one["type"])} for one in columns[schema, name]],
            "key": keys[schema, name],
            "references": sorted(references[schema, name], key=str),
            "unique": sorted(unique[schema, name], key=str),
            "checks": sorted(checks[schema, name], key=str),
            "indices": sorted((_plain(index) for index in indices[schema, name]), key=str),
        }
        for schema, name in columns
    }


_remembered_words = remembered(_in_words)


def _plain(index: Any) -> dict[str, Any]:
    options = {name: str(value) for name, value in index.get("dialect_options", {}).items()}
    return {**index, "dialect_options": options}


@contextmanager
def counted() -> Iterator[list[str]]:
    """Collect the statements that change something as they are executed."""
    seen: list[str] = []

    def note(_c: Any, _cursor: Any, statement: str, *_: Any) -> None:
        if statement.split(None, 1)[0].upper() not in READING:
            seen.append(statement)

    event.listen(Engine, "after_cursor_execute", note)
    try:
        yield seen
    finally:
        event.remove(Engine, "after_cursor_execute", note)


@contextmanager
def stopped_after(changes: int) -> Iterator[list[str]]:
    """Raise `Interrupted` after the statement with this number, or instead of the commit.

    Yields the statements executed so far, as `counted` does.
    """
    with counted() as seen:

        def stop(*_: Any) -> None:
            if len(seen) >= changes:
                raise Interrupted

        for moment in ("after_cursor_execute", "commit"):
            event.listen(Engine, moment, stop)
        try:
            yield seen
        finally:
            for moment in ("after_cursor_execute", "commit"):
                event.remove(Engine, moment, stop)


def killed_after(url: str, revision: str, after_s: float) -> bool:
    """Migrate in a process killed `after_s` after its first statement; return if it was killed."""
    process = multiprocessing.get_context("spawn").Process(
        target=_upgrade_and_die, args=(url, revision, after_s)
    )
    process.start()
    process.join()
    assert process.exitcode in (0, -signal.SIGKILL), process.exitcode
    return process.exitcode != 0


def _upgrade_and_die(url: str, revision: str, after_s: float) -> None:
    kill = threading.Timer(after_s, os.kill, (os.getpid(), signal.SIGKILL))
    kill.daemon = True
    # The time counts from the first statement, so loading the modules is not included.
    event.listen(Engine, "before_cursor_execute", lambda *_: kill.start(), once=True)
    upgrade(url, revision)
