"""Measure the size of each table, and the share of each session.

The engine itself reports the size of a table, indexes included, but not the shares of sessions. A
row counts by the length of its long columns (which both engines report without reading them)
plus a constant; a session with a tenth of a table's total length gets a tenth of its size.
"""

import logging
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import (
    JSON,
    Column,
    ColumnElement,
    LargeBinary,
    String,
    Table,
    Text,
    cast,
    func,
    select,
    text,
)
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from app.database import Base
from app.features.care.storage.schemas import Method
from app.models import Answer, ScoreValue, Submission

log = logging.getLogger(__name__)
# This visits the inner pages of every tree; the content of pages is not read.
_DBSTAT = text(
    "SELECT coalesce(m.tbl_name, s.name), sum(s.pgsize) FROM dbstat AS s "
    "LEFT JOIN sqlite_master AS m ON m.name = s.name WHERE s.aggregate = 1 GROUP BY 1"
)
_RELATIONS = text(
    "SELECT relname, pg_total_relation_size(oid) FROM pg_class "
    "WHERE relkind = 'r' AND relnamespace = current_schema()::regnamespace"
)
SHORT_COLUMNS_BYTES = 100
"""Approximate size of the numbers and short texts of a row."""
OF_SUBMISSIONS = (Answer.__table__, ScoreValue.__table__)
"""Tables whose rows belong to a session through their form."""


@dataclass(frozen=True)
class TableSizes:
    """Bytes of each table, measured by `method`; without `dbstat` only `whole_bytes` are known.

    `unused_bytes`: free pages in the file, which will be reused. `log_bytes`: of the write-ahead
    log next to it.
    """

    method: Method
    bytes: dict[str, int]
    whole_bytes: int
    unused_bytes: int = 0
    log_bytes: int = 0


def table_sizes(db: Session) -> TableSizes:
    """Query the sizes of all tables from the engine."""
    if db.get_bind().dialect.name == "sqlite":
        return _of_sqlite(db)
    sizes = {str(name): int(size) for name, size in db.execute(_RELATIONS)}
    return TableSizes("pg_total_relation_size", sizes, sum(sizes.values()))


def _of_sqlite(db: Session) -> TableSizes:
    page_bytes = int(db.scalar(text("PRAGMA page_size")) or 0)
    pages = int(db.scalar(text("PRAGMA page_count")) or 0)
    free = int(db.scalar(text("PRAGMA freelist_count")) or 0)
    log_bytes = _log_bytes(db)
    try:
        sizes = {str(name): int(size) for name, size in db.execute(_DBSTAT)}
    except OperationalError:
        log.info("this SQLite has no dbstat: only the size of the whole database is known")
        return TableSizes(
            "page_counts", {}, (pages - free) * page_bytes, free * page_bytes, log_bytes
        )
    return TableSizes("dbstat", sizes, pages * page_bytes, free * page_bytes, log_bytes)


def _log_bytes(db: Session) -> int:
    file = db.get_bind().engine.url.database
    log_file = Path(f"{file}-wal")
    return log_file.stat().st_size if file and log_file.is_file() else 0


def bytes_by_session(db: Session, sizes: Mapping[str, int]) -> dict[str, float]:
    """Return the bytes of each session (id -> bytes) in tables of these `sizes`."""
    shared: defaultdict[str, float] = defaultdict(float)
    for table in Base.metadata.sorted_tables:
        if sizes.get(table.name):
            for session_id, share in _shares(db, table).items():
                shared[session_id] += share * sizes[table.name]
    return dict(shared)


def _shares(db: Session, table: Table) -> dict[str, float]:
    lengths = _lengths(db, table)
    whole = sum(lengths.values())
    return {session_id: length / whole for session_id, length in lengths.items() if whole}


def _lengths(db: Session, table: Table) -> dict[str, int]:
    length = func.count() * SHORT_COLUMNS_BYTES
    for column in table.columns:
        if isinstance(column.type, LargeBinary | JSON | Text):
            length = length + func.coalesce(func.sum(_length(column)), 0)
    if table.name == "sessions":
        query = select(table.c.id, length).group_by(table.c.id)
    elif "session_id" in table.columns:
        query = select(table.c.session_id, length).group_by(table.c.session_id)
    elif table in OF_SUBMISSIONS:
        forms = Submission.__table__
        query = (
            select(forms.c.session_id, length)
            .select_from(table)
            .join(forms, forms.c.id == table.c.submission_id)
            .group_by(forms.c.session_id)
        )
    else:
        return {}
    return {str(owner): int(size) for owner, size in db.execute(query) if owner is not None}


def _length(column: "Column[object]") -> ColumnElement[int]:
    if isinstance(column.type, LargeBinary):
        return func.length(column)
    return func.length(cast(column, String))
