"""What each session takes: the sizes of tables, shared out by the length of their rows.

No engine tells how much of a table belongs to whom. A row counts for what its long columns hold
(which both engines tell without reading them) and a little more, so that of a table of a thousand
bytes a session with a tenth of the length gets a hundred.
"""

from collections import defaultdict
from collections.abc import Mapping

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
)
from sqlalchemy.orm import Session

from app.database import Base
from app.models import Answer, ScoreValue, Submission

SHORT_COLUMNS_BYTES = 100
"""What the numbers and short words of a row take, about."""
OF_SUBMISSIONS = (Answer.__table__, ScoreValue.__table__)
"""Tables whose rows belong to a session by the form they were handed in with."""


def bytes_by_session(db: Session, sizes: Mapping[str, int]) -> dict[str, float]:
    """Bytes of each session (id -> bytes) in tables of these `sizes`."""
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
