"""Request and response models of the pre-flight endpoints.

A response contains no texts: the page looks up the text of each finding by its `code`.
"""

from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.features.record.preflight.check import Expected, Unit
from app.features.record.preflight.checks.registry import CHECKS

CheckStatus = Literal["ok", "unneeded", "wait", "fail", "overridden"]
if TYPE_CHECKING:
    CheckKey = str
    CheckCode = str
else:
    # The interface lists the registry's entries; type checkers do not support a computed Literal.
    CheckKey = Literal[tuple(check.key for check in CHECKS)]
    CheckCode = Literal[tuple(code for check in CHECKS for code in check.codes)]


class Override(BaseModel):
    """The decision to proceed although a check had the finding `found`."""

    reason: str
    found: CheckCode
    by: str
    at: datetime


class Check(BaseModel):
    """A check of the pre-flight list, with its result.

    `wait`: it cannot be judged yet, but will be later without any action. `unneeded`: the session
    uses nothing of what is checked. `value` with its `unit`
    is what was measured; `limit` with `expected` is what it must comply with. `details` are names
    and hashes, which are not translated. `override`: the latest one; it applies only while the
    check still has the finding that was overridden.
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
    """The results of all pre-flight checks.

    `clear`: nothing has failed, or all failures are overridden. `asks`: whether starting in spite
    of failures requires a confirmation. This is the case only for sessions with people; for other
    kinds the list is only shown.
    """

    at: datetime
    clear: bool
    asks: bool
    checks: list[Check]


class OverrideRequest(BaseModel):
    """A request to proceed although a check is not green."""

    model_config = ConfigDict(extra="forbid")

    check: CheckKey
    reason: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=2000)]
