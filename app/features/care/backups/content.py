"""Check that a database contains only what this program can have written.

Checksums show that a file is unchanged since it was written, and SQLite's own check that its
structure is intact. Neither shows that the tables are those of the product, that a column of times
contains times, or that an account's role exists: a damaged value, or a forged backup, would crash
the server where it is read. `wrong_tables` and `wrong_rows` check this without reading long values;
`RestoredContent` checks rows that were just inserted into a database, before they are committed.
"""

import json
import sqlite3
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from types import NoneType

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.features.care.backups.readable import Lifetimes, require_readable
from app.features.care.backups.shapes import Kind, TableShape
from app.features.people.audit import verify_trail
from app.features.record.sessions import events_of, verify_chain
from app.models import StudySession

ROWS_PER_FETCH = 2000
_TYPES: dict[Kind, frozenset[type]] = {
    Kind.TEXT: frozenset({str, NoneType}),
    Kind.INTEGER: frozenset({int, NoneType}),
    Kind.NUMBER: frozenset({int, float, NoneType}),
    Kind.TRUTH: frozenset({int, NoneType}),
    Kind.MOMENT: frozenset({str, NoneType}),
    # SQLite converts JSON that looks like a number to a number.
    Kind.JSON: frozenset({str, int, float, NoneType}),
    # Only the name of SQLite's type is queried, not the bytes.
    Kind.BYTES: frozenset({str}),
}


def columns_in(driver: sqlite3.Connection) -> dict[str, set[str]]:
    """Return the tables of a SQLite file, each with the names of its columns."""
    tables = driver.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
    columns = "SELECT name FROM pragma_table_info(?)"
    return {
        str(name): {str(one) for (one,) in driver.execute(columns, (name,))} for (name,) in tables
    }


def wrong_tables(
    found: Mapping[str, Collection[str]], ours: Sequence[TableShape], *, exactly: bool = False
) -> list[str]:
    """Return a sentence for each missing table or column of `ours`; `exactly`: also for others."""
    wrong = []
    for shape in ours:
        columns = [column.name for column in shape.columns]
        if shape.name not in found:
            wrong.append(f"there is no table {shape.name}")
            continue
        missing = sorted(set(columns) - set(found[shape.name]))
        wrong += [f"there is no column {shape.name}.{column}" for column in missing]
        more = sorted(set(found[shape.name]) - set(columns)) if exactly else []
        wrong += [f"the column {shape.name}.{column} is unknown to this program" for column in more]
    others = sorted(set(found) - {shape.name for shape in ours}) if exactly else []
    return wrong + [f"the table {name} is unknown to this program" for name in others]


def wrong_rows(driver: sqlite3.Connection, shapes: Iterable[TableShape]) -> Iterator[str]:
    """Yield a sentence for each column with values of a wrong type.

    No value is repeated: it may be a participant's answer. Raises SQLite's error if a row cannot be
    read at all; `app.platform.trouble.proves_damage` interprets it.
    """
    for shape in shapes:
        wrong: set[str] = set()
        selected = ", ".join(_select_expression(one.name, one.kind) for one in shape.columns)
        # The names are those of the schema, from the models or migrations.
        rows = driver.execute(f'SELECT {selected} FROM "{shape.name}"')  # noqa: S608 - names of our schema
        while portion := rows.fetchmany(ROWS_PER_FETCH):
            for one, values in zip(shape.columns, zip(*portion, strict=True), strict=True):
                if one.name not in wrong and not _fit(one.kind, values):
                    wrong.add(one.name)
                    yield f"{shape.name}.{one.name} has values other than {_NAMES[one.kind]}"


_NAMES = {
    Kind.TEXT: "text",
    Kind.INTEGER: "whole numbers",
    Kind.NUMBER: "numbers",
    Kind.TRUTH: "true or false",
    Kind.MOMENT: "times",
    Kind.JSON: "JSON",
    Kind.BYTES: "bytes",
}


def _select_expression(name: str, kind: Kind) -> str:
    return f'typeof("{name}")' if kind is Kind.BYTES else f'"{name}"'


def _fit(kind: Kind, values: Sequence[object]) -> bool:
    if not set(map(type, values)) <= _TYPES[kind]:
        return False
    match kind:
        case Kind.MOMENT:
            return _all_read(datetime.fromisoformat, values)
        case Kind.JSON:
            return _all_read(json.loads, values)
        case Kind.TRUTH:
            return set(values) <= {0, 1, None}
        case Kind.BYTES:
            return set(values) <= {"blob", "null"}
        case _:
            return True


def _all_read(read: Callable[[str], object], values: Iterable[object]) -> bool:
    try:
        for value in {one for one in values if isinstance(one, str)}:
            read(value)
    except (ValueError, RecursionError):
        return False
    return True


@dataclass
class RestoredContent:
    """The check of restored rows, inside the restore's transaction.

    `even_though_altered`: accept a record whose hash chains do not verify, because a person decided
    so. `lifetimes`: how long logins, pairing codes and invitations in it may still last, None to
    leave them unchanged.
    """

    even_though_altered: bool = False
    lifetimes: Lifetimes | None = None

    def __call__(self, db: Session) -> None:
        """Raise InvalidInput for rows that cannot be read, and for chains that do not verify."""
        if not self.even_though_altered:
            _require_chains(db)
        require_readable(db, even_though_altered=self.even_though_altered)
        if self.lifetimes is not None:
            self.lifetimes.shorten(db)
        db.expunge_all()


def _require_chains(db: Session) -> None:
    broken = [] if verify_trail(db).ok else ["the audit trail"]
    sessions = select(StudySession.id, StudySession.version).order_by(StudySession.created_at)
    for session_id, version in db.execute(sessions).all():
        if not verify_chain(events_of(db, session_id), version=version).ok:
            broken.append(f"session {session_id}")
        db.expunge_all()
    if broken:
        more = f" and {len(broken) - 3} more" if len(broken) > 3 else ""
        raise InvalidInput(
            f"the record in the backup was altered: the chain of {', '.join(broken[:3])}{more} "
            "does not verify; nothing was changed",
            value=broken,
            valid="chains of which every hash follows from the one before",
            remedy="Take another backup; or, knowing that this record cannot be relied on, say "
            "--even-though-altered.",
        )
