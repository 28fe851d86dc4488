"""What part of a study's sessions is looked at: an honest choice, told beside every figure.

A filter is part of the address of a page, so that what somebody saw can be shown to somebody else.
It chooses what is drawn. Tests take no filter: what is tested was declared beforehand.
"""

from datetime import date
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Rows = Literal["valid", "all"]
LimbChoice = Literal["hand", "foot"]
Code = Annotated[str, StringConstraints(min_length=1, max_length=80)]
MOST_PARTICIPANTS = 200
_SHOWN = 6


class FigureFilter(BaseModel):
    """Which sessions and rows are drawn; everything unless named.

    `rows`: "valid" leaves out what does not count (broken-off sessions, superseded and skipped
    steps), "all" draws it too. `since` and `until`: days, both included, on which a session was
    created, in UTC. `order`: added latencies in ms in the order of the blocks, as in "0 125 350".
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    participant: Annotated[tuple[Code, ...], Field(max_length=MOST_PARTICIPANTS)] = ()
    order: Annotated[str | None, Field(max_length=80)] = None
    rows: Rows = "valid"
    since: date | None = None
    until: date | None = None
    limb: LimbChoice | None = None

    @property
    def is_all(self) -> bool:
        """Whether nothing was chosen."""
        return self == FigureFilter()

    def words(self) -> str:
        """What was chosen, as the sentence that stands in captions and files; empty for nothing."""
        told = [*self._of_whom(), *self._when()]
        if self.limb is not None:
            told.append(f"the {self.limb} task")
        chosen = f"Only {', '.join(told)}." if told else ""
        everything = "Rows that do not count are drawn too (broken off, superseded, skipped)."
        return f"{chosen} {everything if self.rows == 'all' else ''}".strip()

    def _of_whom(self) -> list[str]:
        told = []
        if self.participant:
            shown = ", ".join(self.participant[:_SHOWN])
            more = len(self.participant) - _SHOWN
            told.append(f"participants {shown}{f' and {more} more' if more > 0 else ''}")
        if self.order is not None:
            told.append(f"order {self.order.replace(' ', ' → ')} ms")
        return told

    def _when(self) -> list[str]:
        if self.since is not None and self.until is not None:
            return [f"sessions from {self.since} to {self.until} (UTC)"]
        if self.since is not None:
            return [f"sessions since {self.since} (UTC)"]
        return [f"sessions until {self.until} (UTC)"] if self.until is not None else []


NO_FILTER = FigureFilter()
