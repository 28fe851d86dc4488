"""What every event is."""

from dataclasses import dataclass
from typing import ClassVar


@dataclass(frozen=True, kw_only=True)
class Event:
    """Base of all events; `type` is its stored name."""

    type: ClassVar[str]
