"""Shortfalls: the rules of a study that a completed session does not meet, so it is not valid."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, TypeAdapter

from app.protocol import PHASES

ShortfallCode = Literal[
    "consent_skipped",
    "phase_skipped",
    "phase_short",
    "phase_doubtful",
    "form_skipped",
    "latency_missing",
    "latency_off",
    "headset_doubtful",
]


class Shortfall(BaseModel):
    """A rule of the study that a session does not meet.

    `step` is the step's key in the plan and `phase` its name in the rules; for a form, both name
    the phase that the form is about, if there is one. `value` is what was found and `limit` what is
    required: seconds of active time, or milliseconds between the achieved and the set latency.
    Neither reveals the condition.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    code: ShortfallCode
    step: str
    block: int | None = None
    phase: str | None = None
    instrument: str | None = None
    value: float | None = None
    limit: float | None = None

    def words(self) -> str:
        """Describe the shortfall as a clause in English."""
        parts = (
            None if self.block is None else f"block {self.block}",
            None if self.phase is None else _name(self.phase),
        )
        place = ", ".join(part for part in parts if part)
        return f"{place}: {self._what()}" if place else self._what()

    def _what(self) -> str:
        match self.code:
            case "consent_skipped":
                return "no consent on record"
            case "phase_skipped":
                return "skipped"
            case "phase_short":
                return f"{self.value:.1f} s of active time, at least {self.limit:g} s needed"
            case "phase_doubtful":
                return "what the headset said of it cannot be true"
            case "headset_doubtful":
                return "what the headset said of the whole session cannot be true"
            case "form_skipped":
                return f"questionnaire {self.instrument} not answered"
            case "latency_missing":
                return "no achieved latency could be measured"
            case "latency_off":
                return f"achieved latency off by {self.value:.0f} ms (limit {self.limit:g} ms)"


def _name(phase: str) -> str:
    """Return the name of a phase for use in a sentence, or its key if its kind is unknown."""
    return PHASES[phase].in_a_sentence.en if phase in PHASES else phase


_STORED = TypeAdapter(tuple[Shortfall, ...])


def shortfalls_of(stored: Sequence[Mapping[str, Any]] | None) -> tuple[Shortfall, ...]:
    """Parse the shortfalls that are stored with a session (`StudySession.shortfalls`)."""
    return _STORED.validate_python(list(stored or ()))
