"""Times that a client's own clock states, within what the calendar and every database can hold."""

from datetime import UTC, datetime
from typing import Annotated

from pydantic import AfterValidator, AwareDatetime

EARLIEST = datetime(1970, 1, 1, tzinfo=UTC)
"""Where the clock of a device starts that has lost its time."""
LATEST = datetime(2200, 1, 1, tzinfo=UTC)


def _within_range(time: datetime) -> datetime:
    # Compared before any conversion, which overflows at the ends of the calendar.
    if not EARLIEST <= time < LATEST:
        raise ValueError(
            f"{time.isoformat()} is no time of a device: it must be from {EARLIEST.isoformat()} "
            f"to before {LATEST.isoformat()}"
        )
    return time


ClientTime = Annotated[AwareDatetime, AfterValidator(_within_range)]
"""A time with its offset to UTC, from 1970 to 2199, by the clock of the device that sent it."""
