"""Remove a whole study with everything that belongs to it.

Only the demo lab may be removed like this: a study of people keeps its record, from which single
participants are erased.
"""

from sqlalchemy import ColumnElement, Table, delete, or_, select
from sqlalchemy.orm import Session

from app.database import Base
from app.models import Study


def remove_study(db: Session, study: Study) -> int:
    """Delete a study and every row that refers to it, directly or not; return how many rows.

    The foreign keys say what belongs to it, so that no table can be forgotten.
    """
    tables = Base.metadata.sorted_tables
    belonging: dict[str, ColumnElement[bool]] = {Study.__tablename__: Study.id == study.id}
    for table in tables:
        if table.name not in belonging and (own := _refers(table, belonging)):
            belonging[table.name] = or_(*own)
    removed = 0
    for table in reversed(tables):
        if table.name in belonging:
            result = db.execute(delete(table).where(belonging[table.name]))
            removed += result.rowcount  # type: ignore[attr-defined]  # of a DELETE
    return removed


def _refers(table: Table, belonging: dict[str, ColumnElement[bool]]) -> list[ColumnElement[bool]]:
    """Return a condition for every column that refers to a row which belongs to the study.

    Of a key of several columns the first one decides: it is the row's owner in all our tables.
    """
    conditions: list[ColumnElement[bool]] = []
    for constraint in table.foreign_key_constraints:
        first = constraint.elements[0]
        parent = first.column.table
        if parent.name in belonging and parent is not table:
            owned = select(first.column).where(belonging[parent.name])
            conditions.append(first.parent.in_(owned))
    return conditions
