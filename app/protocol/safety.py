"""Stop rules: limits on scores of a session, at which the session is held.

A *stop rule* checks one score each time its instrument is answered. At `warn_at` the operator is
warned; at `stop_at` the session is held until the operator ends it or continues with a reason. The
checks below report rules and practice phases that could never have an effect.
"""

from collections.abc import Iterator, Mapping
from typing import Annotated, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, refusal
from app.protocol.source import Path, Plain
from app.protocol.step_kinds import STEP_KINDS
from app.science.instruments import DefinitionProblem, Instrument, Score

FormKey = Annotated[
    str,
    StringConstraints(min_length=1, max_length=80),
    Field(description="the key of a form before the blocks, such as form.fms"),
]


class StopRule(Strict):
    """A limit on one score; a score at or above the limit reaches it.

    `change_from`: the form before the blocks with the baseline; the limits then apply to the rise
    since then, not to the score itself.
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
    """The stop rules of a study, in the order in which they are checked."""

    stop_rules: Annotated[tuple[StopRule, ...], Field(min_length=1, max_length=10)]


def safety_problems(
    tree: Mapping[str, Plain], instruments: Mapping[str, Instrument]
) -> Iterator[DefinitionProblem]:
    """Yield the problems of stop rules.

    These are instruments that are not asked, unknown scores, and limits beyond the score's range.
    """
    rules = _list(_dict(tree.get("safety")).get("stop_rules"))
    for at, rule in enumerate(rules):
        if isinstance(rule, dict):
            yield from _rule(("safety", "stop_rules", at), rule, tree, instruments)


def body_problems(tree: Mapping[str, Plain]) -> Iterator[DefinitionProblem]:
    """Yield a problem for each phase that needs a body, such as practice, before the body's step.

    This is the step in which the participant gets a body.
    """
    before = [_dict(step).get("step") for step in _list(_dict(tree.get("procedure")).get("before"))]
    for at, kind in enumerate(before):
        spec = STEP_KINDS.get(str(kind))
        if spec is not None and spec.needs_body and "materialise" not in before[:at]:
            yield DefinitionProblem(
                ("procedure", "before", at, "step"),
                f"The step “{spec.name.en.lower()}” comes before the participant has a body.",
                kind,
                "a place after the step materialise",
                "Move it after the step materialise.",
            )


def _rule(
    path: Path,
    rule: dict[str, Plain],
    tree: Mapping[str, Plain],
    instruments: Mapping[str, Instrument],
) -> Iterator[DefinitionProblem]:
    key = rule.get("instrument")
    if not isinstance(key, str):
        return
    early, late = _instruments_asked(tree)
    if key not in early:
        valid = sorted(early)
        when = "only after the blocks, when there is nothing left to stop" if key in late else ""
        yield DefinitionProblem(
            (*path, "instrument"),
            f"The study asks {key!r} {when}." if when else f"The study does not ask {key!r}.",
            key,
            valid,
            "Ask it before, in or at the end of the blocks, or use one of: "
            f"{', '.join(valid) or 'none is asked'}.",
        )
    if key in instruments:
        yield from _score(path, rule, instruments[key])
    yield from _start(path, rule, key, tree)


def _score(
    path: Path, rule: dict[str, Plain], instrument: Instrument
) -> Iterator[DefinitionProblem]:
    key = rule.get("score")
    by_key = {score.key: score for score in instrument.scores}
    if isinstance(key, str) and key not in by_key:
        yield DefinitionProblem(
            (*path, "score"),
            f"The instrument {instrument.key!r} has no score {key!r}.",
            key,
            sorted(by_key),
            f"Use one of: {', '.join(sorted(by_key)) or 'it has none'}.",
        )
    elif isinstance(key, str):
        for field in ("stop_at", "warn_at"):
            limit = rule.get(field)
            if isinstance(limit, int | float) and not isinstance(limit, bool):
                yield from _limit((*path, field), limit, by_key[key], rule.get("change_from"))


def _limit(
    path: Path, limit: float, score: Score, change_from: Plain
) -> Iterator[DefinitionProblem]:
    if score.minimum is None or score.maximum is None:
        return
    low, high = score.minimum, score.maximum
    if change_from is not None:
        low, high = 0.0, high - low
    # With the lowest value as the limit, every participant would reach it.
    if not low < limit <= high:
        what = "rise" if change_from is not None else "score"
        yield DefinitionProblem(
            path,
            f"The limit {limit:g} is reached by everybody or by nobody: the {what} of "
            f"{score.key!r} goes from {low:g} to {high:g}.",
            limit,
            f"above {low:g}, at most {high:g}",
            f"Give a limit above {low:g} and at most {high:g}.",
        )


def _start(
    path: Path, rule: dict[str, Plain], key: str, tree: Mapping[str, Plain]
) -> Iterator[DefinitionProblem]:
    """Yield a problem if `change_from` names no suitable form.

    The form must be before the blocks and have the same instrument.
    """
    start = rule.get("change_from")
    if not isinstance(start, str):
        return
    forms = _forms_before(tree)
    fitting = [name for name, instrument in forms if instrument == key]
    if start not in fitting:
        yield DefinitionProblem(
            (*path, "change_from"),
            f"There is no form {start!r} with the instrument {key!r} before the blocks.",
            start,
            fitting,
            f"Use one of: {', '.join(fitting)}."
            if fitting
            else f"Add a step {{step: form, instrument: {key}}} before the blocks.",
        )


def asked_instruments(tree: Mapping[str, Plain]) -> set[str]:
    """Return the keys of all instruments that a study asks."""
    early, late = _instruments_asked(tree)
    return early | late


def _instruments_asked(tree: Mapping[str, Plain]) -> tuple[set[str], set[str]]:
    """Return the instruments asked up to the end of the last block, and those asked after it."""
    procedure = _dict(tree.get("procedure"))
    block = _dict(procedure.get("block"))
    early = [
        *(_dict(step).get("instrument") for step in _list(procedure.get("before"))),
        _dict(block.get("crossing")).get("questionnaire"),
        *(_dict(phase).get("questionnaire") for phase in _list(block.get("phases"))),
        *(_dict(step).get("instrument") for step in _list(block.get("after"))),
    ]
    late = [_dict(step).get("instrument") for step in _list(procedure.get("after"))]
    return {one for one in early if isinstance(one, str)}, {
        one for one in late if isinstance(one, str)
    }


def _forms_before(tree: Mapping[str, Plain]) -> list[tuple[str, str]]:
    """Return the forms before the blocks by their keys in the plan, with their instrument."""
    seen: dict[str, int] = {}
    forms = []
    for step in _list(_dict(tree.get("procedure")).get("before")):
        instrument = _dict(step).get("instrument")
        if isinstance(instrument, str):
            count = seen[instrument] = seen.get(instrument, 0) + 1
            name = f"form.{instrument}" if count == 1 else f"form.{instrument}.{count}"
            forms.append((name, instrument))
    return forms


def _dict(value: Plain) -> dict[str, Plain]:
    return value if isinstance(value, dict) else {}


def _list(value: Plain) -> list[Plain]:
    return value if isinstance(value, list) else []
