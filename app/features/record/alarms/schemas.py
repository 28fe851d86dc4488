"""Alarms as pages see them."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel


class AlarmView(BaseModel):
    """One alarm from its raising to its clearing; `cleared_at` is null while it is open.

    `value` with its `unit` says how much when it was raised, `client_t_s` when it was on the
    headset's clock. `outcome` says why it was cleared, where there is more to say than that its
    cause was gone.
    """

    id: str
    code: str
    severity: Literal["info", "warning", "critical"]
    stream: str | None
    message: str
    value: float | None
    unit: str | None
    client_t_s: float | None
    since: datetime
    cleared_at: datetime | None
    outcome: str | None
