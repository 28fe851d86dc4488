"""The rules by which a completed session counts as valid, as declared by the study.

A study without `valid_when` counts every session that was neither aborted nor withdrawn. With it, a
completed session must satisfy all rules; one that does not keeps its data, is marked as not valid
in every table and figure, and releases its slot of the ledger for another participant.
"""

from collections.abc import Iterator, Mapping
from typing import Annotated, Self, TypeGuard

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, refusal
from app.protocol.source import Path, Plain
from app.protocol.step_kinds import PHASES, ROAD_KINDS, STEP_KINDS, StepKind
from app.science.instruments import DefinitionProblem

_MAX_TOLERANCE_MS = 10_000.0
_AT: Path = ("valid_when",)

PhaseKey = Annotated[
    str,
    StringConstraints(min_length=1, max_length=40),
    Field(description=f"one of the study's phases: {', '.join(PHASES)}"),
]


class PhaseRule(Strict):
    """A timed phase that must have been completed, in every block if it is part of the blocks.

    The minimum active time is given in seconds (`min_active_s`) or as a share of the phase's own
    time (`min_active_share`); pauses and walks back do not count.
    """

    phase: PhaseKey
    min_active_s: Annotated[float | None, Field(gt=0, le=86_400, description="seconds")] = None
    min_active_share: Annotated[
        float | None, Field(gt=0, le=1, description="share of the phase's time, above 0 to 1")
    ] = None

    @model_validator(mode="after")
    def _says_it_once(self) -> Self:
        if self.min_active_s is not None and self.min_active_share is not None:
            raise refusal(
                "The minimum active time is given twice.",
                value=self.min_active_share,
                valid="min_active_s or min_active_share",
                remedy="Keep one of them.",
                at=("min_active_share",),
            )
        return self

    def least_s(self, duration_s: float) -> float:
        """Return the minimum active time of a phase of this duration, in seconds.

        0 if there is none.
        """
        return self.min_active_s or (self.min_active_share or 0.0) * duration_s


class LatencyRule(Strict):
    """The requirements on the avatar's achieved latency, in the phases that are listed.

    `reported`: the latency must have been measured. `tolerance_ms`: if it was measured, the largest
    difference from the set latency. A body that is moved by physics adds its own lag.
    """

    reported: bool
    tolerance_ms: Annotated[
        float | None, Field(gt=0, le=_MAX_TOLERANCE_MS, description="milliseconds, above 0")
    ] = None


class ValidWhen(Strict):
    """The requirements for a completed session to count.

    `phases`: the timed phases; `forms`: the instruments, of which every form must have been
    answered; `achieved_latency`: the rule for the latency of phases.
    """

    phases: Annotated[tuple[PhaseRule, ...], Field(max_length=20)] = ()
    forms: Annotated[tuple[Key, ...], Field(max_length=50)] = ()
    achieved_latency: LatencyRule | None = None

    @model_validator(mode="after")
    def _asks_for_something(self) -> Self:
        if not self.phases and not self.forms:
            raise refusal(
                "The rules require nothing, so every completed session would satisfy them.",
                value=None,
                valid="at least one phase or form",
                remedy="Name a phase or a form, or leave valid_when out.",
            )
        for field, keys in (("phases", [one.phase for one in self.phases]), ("forms", self.forms)):
            for at, key in enumerate(keys):
                if key in keys[:at]:
                    raise refusal(
                        f"{key!r} is named twice.",
                        value=key,
                        valid="every phase and form once",
                        remedy="Name it once.",
                        at=(field, at),
                    )
        if self.achieved_latency is not None and not self.phases:
            raise refusal(
                "The achieved latency is that of the phases, but none is listed.",
                value=None,
                valid="at least one phase",
                remedy="List the phases, or leave achieved_latency out.",
                at=("achieved_latency",),
            )
        return self


def validity_problems(tree: Mapping[str, Plain]) -> Iterator[DefinitionProblem]:
    """Yield the problems of the rules of validity.

    These are unknown phases or forms, and minimum times longer than the phase itself.
    """
    rules = _dict(tree.get("valid_when"))
    durations = _durations(tree)
    for at, rule in enumerate(_list(rules.get("phases"))):
        path: Path = (*_AT, "phases", at)
        key, least = _dict(rule).get("phase"), _dict(rule).get("min_active_s")
        if not isinstance(key, str):
            continue
        if key not in durations:
            yield _unknown((*path, "phase"), "phase", key, list(durations))
            continue
        longest = durations[key]
        if _is_number(least) and longest is not None and least > longest:
            yield DefinitionProblem(
                (*path, "min_active_s"),
                f"The phase {key!r} has only {longest:g} s of active time, so no session would "
                "count.",
                least,
                f"above 0, at most {longest:g}",
                f"Require at most {longest:g} s.",
            )
    forms = _forms(tree)
    for at, key in enumerate(_list(rules.get("forms"))):
        if isinstance(key, str) and key not in forms:
            yield _unknown((*_AT, "forms", at), "form", key, forms)


def _unknown(path: Path, what: str, key: str, valid_keys: list[str]) -> DefinitionProblem:
    return DefinitionProblem(
        path,
        f"The study has no {what} {key!r}.",
        key,
        valid_keys,
        f"Use one of: {', '.join(valid_keys) or 'none is in the procedure'}.",
    )


def _durations(tree: Mapping[str, Plain]) -> dict[str, float | None]:
    """Return the keys of all timed phases, each with the shortest active time specified for it.

    A phase that can end early has no such time.
    """
    procedure = _dict(tree.get("procedure"))
    phases: list[tuple[str, Plain, bool]] = []
    for step in map(_dict, _list(procedure.get("before"))):
        spec = STEP_KINDS.get(str(step.get("step")))
        key = None if spec is None else spec.key_of_phase(step.get("limb"))
        if key is not None:
            early = step.get("repeat_until_completions") is not None
            phases.append((key, step.get("duration_s"), early))
    block = [_dict(phase) for phase in _list(_dict(procedure.get("block")).get("phases"))]
    phases += [(str(phase.get("limb")), phase.get("duration_s"), False) for phase in block]
    crossing = _dict(procedure.get("block")).get("crossing")
    if isinstance(crossing, dict):
        # It may end early, after the last crossing.
        phases += [(key, None, True) for kind in ROAD_KINDS if (key := _phase_key(kind))]
    if len({str(phase.get("limb")) for phase in block}) < len(block):
        # A duplicate limb is reported elsewhere; accept both, because which one is missing is
        # unknown.
        phases += [("hand", None, False), ("foot", None, False)]
    found: dict[str, float | None] = {}
    for key, duration, early in phases:
        given = float(duration) if _is_number(duration) and not early else None
        earlier = found.get(key, given)
        found[key] = None if given is None or earlier is None else min(given, earlier)
    return found


def _phase_key(kind: StepKind) -> str | None:
    return STEP_KINDS[kind].key_of_phase(None)


def _forms(tree: Mapping[str, Plain]) -> list[str]:
    """Return every instrument that the study asks, in the order of the procedure."""
    procedure = _dict(tree.get("procedure"))
    block = _dict(procedure.get("block"))
    keys = [
        *(_dict(step).get("instrument") for step in _list(procedure.get("before"))),
        _dict(block.get("crossing")).get("questionnaire"),
        *(_dict(phase).get("questionnaire") for phase in _list(block.get("phases"))),
        *(_dict(step).get("instrument") for step in _list(block.get("after"))),
        *(_dict(step).get("instrument") for step in _list(procedure.get("after"))),
    ]
    return list(dict.fromkeys(one for one in keys if isinstance(one, str)))


def _is_number(value: Plain) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _dict(value: Plain) -> dict[str, Plain]:
    return value if isinstance(value, dict) else {}


def _list(value: Plain) -> list[Plain]:
    return value if isinstance(value, list) else []
