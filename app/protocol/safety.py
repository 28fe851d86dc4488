"""When a session must not simply go on: limits on scores that are asked during it.

A *stop rule* looks at one score each time its instrument is filled in. At `warn_at` the operator is
warned; at `stop_at` the session is held until the operator ends it or goes on with a reason.
"""

from typing import Annotated, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, refusal

FormKey = Annotated[
    str,
    StringConstraints(min_length=1, max_length=80),
    Field(description="the key of a form before the blocks, such as form.fms"),
]


class StopRule(Strict):
    """One limit; scores at or above it meet it.

    `change_from`: the form before the blocks that gives the starting point; the limits are then on
    the rise since then, not on the score itself.
    """

    instrument: Key
    score: Key
    stop_at: float
    warn_at: float | None = None
    change_from: FormKey | None = None

    @model_validator(mode="after")
    def _warns_first(self) -> Self:
        if self.warn_at is not None and self.warn_at >= self.stop_at:
            raise refusal(
                f"The rule warns at {self.warn_at:g}, which is not below its limit of "
                f"{self.stop_at:g}.",
                value=self.warn_at,
                valid=f"below {self.stop_at:g}",
                remedy="Warn earlier than the session is held, or leave warn_at out.",
                at=("warn_at",),
            )
        return self


class Safety(Strict):
    """The stop rules of a study, in the order in which they are looked at."""

    stop_rules: Annotated[tuple[StopRule, ...], Field(min_length=1, max_length=10)]
