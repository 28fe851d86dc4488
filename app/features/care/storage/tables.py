"""How large each table is, indexes included, as the engine itself tells it."""

import logging
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import text
from sqlalchemy.exc import OperationalError
from sqlalchemy.orm import Session

from app.features.care.storage.schemas import Method

log = logging.getLogger(__name__)
# A walk over the inner pages of every tree; what a page holds is not read.
_DBSTAT = text(
    "SELECT coalesce(m.tbl_name, s.name), sum(s.pgsize) FROM dbstat AS s "
    "LEFT JOIN sqlite_master AS m ON m.name = s.name WHERE s.aggregate = 1 GROUP BY 1"
)
_RELATIONS = text(
    "SELECT relname, pg_total_relation_size(oid) FROM pg_class "
    "WHERE relkind = 'r' AND relnamespace = current_schema()::regnamespace"
)


@dataclass(frozen=True)
class TableSizes:
    """Bytes of each table, told by `method`; without `dbstat` only `whole_bytes` are known.

    `unused_bytes`: pages in the file that hold nothing and are used again. `log_bytes`: of the
    write-ahead log beside it.
    """

    method: Method
    bytes: dict[str, int]
    whole_bytes: int
    unused_bytes: int = 0
    log_bytes: int = 0


def table_sizes(db: Session) -> TableSizes:
    """Ask the engine behind `db`."""
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
