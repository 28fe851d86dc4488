"""The list of checks as pages see it. Its words are the page's: `code` names what was found."""

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.features.record.preflight.check import Expected, Unit
from app.features.record.preflight.checks import CHECKS

CheckStatus = Literal["ok", "wait", "fail", "overridden"]
if TYPE_CHECKING:
    CheckKey = str
    CheckCode = str
else:
    # The interface lists what the registry holds; no type checker reads a computed Literal.
    CheckKey = Literal[tuple(check.key for check in CHECKS)]
    CheckCode = Literal[tuple(code for check in CHECKS for code in check.codes)]


class Override(BaseModel):
    """Somebody goes on all the same, although this was `found`."""

    reason: str
    found: CheckCode
    by: str
    at: datetime


class Check(BaseModel):
    """One line of the list.

    `wait`: it cannot be told yet, and comes by itself. `value` with its `unit` is what was found,
    `limit` with `expected` what it must keep to. `details` are names and hashes, in no language.
    `override`: the newest one; it counts while the finding is the one it was said of.
    """

    key: CheckKey
    status: CheckStatus
    code: CheckCode
    value: float | None = None
    unit: Unit | None = None
    expected: Expected | None = None
    limit: float | None = None
    details: tuple[str, ...] = ()
    override: Override | None = None


class Preflight(BaseModel):
    """The whole list, made anew. `clear`: nothing has failed, or what did was overridden.

    `asks`: whether a start with failures is asked about. Only sessions with people are: the others
    show the list and never stand in the way.
    """

    at: datetime
    clear: bool
    asks: bool
    checks: list[Check]


class OverrideRequest(BaseModel):
    """Go on although a check is not green."""

    model_config = ConfigDict(extra="forbid")

    check: CheckKey
    reason: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=2000)]
