"""Column types and keys shared by all tables."""

import uuid
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Annotated, Any

from sqlalchemy import DateTime, Dialect, String
from sqlalchemy.orm import mapped_column
from sqlalchemy.types import TypeDecorator

from app.errors import DamagedValue


class UtcDateTime(TypeDecorator[datetime]):
    """A timezone-aware UTC time on every database; a naive value is rejected."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:
        """Convert to UTC for storage; SQLite stores no time zone, so it is removed there."""
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError(f"expected an aware time, got {value!r}")
        utc = value.astimezone(UTC)
        return utc.replace(tzinfo=None) if dialect.name == "sqlite" else utc

    def process_result_value(self, value: datetime | None, _dialect: Dialect) -> datetime | None:
        """Add the time zone again if the database does not store it."""
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)

    def result_processor(
        self, dialect: Dialect, coltype: object
    ) -> Callable[[Any], datetime | None] | None:
        """Raise DamagedValue for a text that is not a time, because SQLite stores times as text."""
        process = super().result_processor(dialect, coltype)
        if process is None or dialect.name != "sqlite":
            return process

        def checked(value: Any) -> datetime | None:
            if value is None:
                return None
            try:
                # Lists contain thousands of times, nearly all as they are stored here, in UTC.
                return datetime.fromisoformat(value + "+00:00")
            except (ValueError, TypeError):
                pass
            try:
                return process(value)
            except (ValueError, TypeError) as error:
                raise DamagedValue(f"{value!r} is stored where a time should be") from error

        return checked


def new_id() -> str:
    """Return a random identifier of 122 bits, as 32 hexadecimal digits."""
    return uuid.uuid4().hex


Id = Annotated[str, mapped_column(String(32), primary_key=True, default=new_id)]
UtcTime = Annotated[datetime, mapped_column(UtcDateTime)]
"""A column with a UTC time."""
