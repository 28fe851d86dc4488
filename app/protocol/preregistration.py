"""The preregistration of a study: one primary test, and the exclusions, declared in advance.

It is part of the study's content, so it is hashed, versioned and frozen with the rest: the hash in
a registry identifies exactly this text. Everything that is not declared is exploratory.
"""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, refusal
from app.protocol.source import Path, Plain
from app.science.instruments import DefinitionProblem, Instrument
from app.science.statistical_tests import TESTS, Direction, Outcome, Sample, statistical_test

if TYPE_CHECKING:
    from app.science.statistics import FloatArray

Measure = Literal["score", "contact_time", "completions"]
RuleName = Literal[
    "complete_session",
    "minimum_frame_rate_hz",
    "minimum_share_of_frames",
    "maximum_latency_error_ms",
    "minimum_active_time_s",
    "maximum_straight_lined_forms",
]
LIMITS: dict[str, tuple[float, float]] = {
    "minimum_frame_rate_hz": (1.0, 1000.0),
    "minimum_share_of_frames": (0.0, 1.0),
    "maximum_latency_error_ms": (0.0, 10_000.0),
    "minimum_active_time_s": (0.0, 86_400.0),
    "maximum_straight_lined_forms": (0.0, 100.0),
}
"""Lowest and highest sensible limit of each rule that has one."""
_PRIMARY: Path = ("preregistration", "primary")
_COUNTS = {3: "three", 4: "four"}
_FEWEST = 2
if TYPE_CHECKING:
    PrimaryTestName = str
else:
    # A study can declare any registered test; type checkers cannot evaluate a computed Literal.
    PrimaryTestName = Literal[tuple(one.key for one in TESTS)]


class PrimaryTest(Strict):
    """The single primary test of the study.

    `measure`: a score of an instrument that is answered after a task, contact time (s) or
    completions. `limb`: the limb whose task is measured; "both" is the mean of a participant's
    tasks. `factor` is the added latency. `direction`: the direction of the measure as latency
    increases; "against_reference" compares each condition with `reference` by exact signed-rank
    tests, and `correction` adjusts for all of them.
    """

    measure: Measure
    instrument: Key | None = None
    score: Key | None = None
    limb: Literal["hand", "foot", "both"]
    factor: Literal["latency"] = "latency"
    test: PrimaryTestName
    direction: Direction = "two_sided"
    reference: Key | None = None
    correction: Literal["holm", "none"] = "none"

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        named = self.instrument is not None and self.score is not None
        if (self.measure == "score") != named or (self.instrument is None) != (self.score is None):
            raise refusal(
                "The measure score needs an instrument and the key of a score; other measures "
                "have neither.",
                value=self.measure,
                valid="instrument and score with the measure score; neither with other measures",
                remedy="Add the questionnaire after the task and one of its scores, or neither.",
                at=("measure",),
            )
        test = statistical_test(self.test)
        if self.direction not in test.directions:
            raise refusal(
                f"The test {self.test} cannot have the direction {self.direction}.",
                value=self.direction,
                valid=list(test.directions),
                remedy=f"Use one of: {', '.join(test.directions)}.",
                at=("direction",),
            )
        several = test.needs_reference
        if several != (self.reference is not None):
            comparing = " or ".join(one.key for one in TESTS if one.needs_reference)
            raise refusal(
                f"Only the test {comparing} has a reference condition.",
                value=self.reference,
                valid=f"the key of a condition with {comparing}; nothing with other tests",
                remedy="Name the condition that the others are compared with, or remove it.",
                at=("reference",),
            )
        if not several and self.correction != "none":
            raise refusal(
                f"The test {self.test} is a single test, so there is nothing to correct for.",
                value=self.correction,
                valid="none",
                remedy="Leave correction out.",
                at=("correction",),
            )
        return self


class ExclusionRule(Strict):
    """A rule that excludes a session from the primary test.

    A rule on task phases excludes the session if any of them violates it.

    `complete_session`: the session must have been completed. `minimum_frame_rate_hz` and
    `minimum_share_of_frames`: the lowest frame rate of the avatar's frames, and the lowest share of
    active time outside gaps. `maximum_latency_error_ms`: the largest absolute difference between
    achieved and set latency. `minimum_active_time_s`: the shortest active time of a task phase.
    `maximum_straight_lined_forms`: the most forms of a session with identical ratings for all
    items.
    """

    rule: RuleName
    limit: float | None = None

    @model_validator(mode="after")
    def _has_its_limit(self) -> Self:
        low, high = LIMITS.get(self.rule, (None, None))
        if low is None or high is None:
            if self.limit is not None:
                raise refusal(
                    f"The rule {self.rule} has no limit.",
                    value=self.limit,
                    valid="no limit",
                    remedy="Leave limit out.",
                    at=("limit",),
                )
        elif self.limit is None or not low <= self.limit <= high:
            raise refusal(
                f"The rule {self.rule} needs a limit from {low:g} to {high:g}.",
                value=self.limit,
                valid=f"from {low:g} to {high:g}",
                remedy=f"Give a limit from {low:g} to {high:g}.",
                at=("limit",),
            )
        return self


class Preregistration(Strict):
    """The declared analysis.

    `planned_n`: the number of participants in the primary test. `registration`: the place of its
    registration, once there is one.
    """

    alpha: Annotated[float, Field(gt=0, le=0.2, description="above 0, at most 0.2")]
    planned_n: Annotated[int, Field(ge=2, le=10_000, description="participants, 2 to 10000")]
    primary: PrimaryTest
    exclusions: Annotated[tuple[ExclusionRule, ...], Field(max_length=20)] = ()
    registration: Annotated[str, StringConstraints(max_length=300)] = ""

    def outcome_of(
        self,
        values: "FloatArray",
        levels: tuple[str, ...],
        labels: Mapping[str, str] | None = None,
    ) -> Outcome:
        """Run the declared test; people's data and simulated ones are tested alike.

        Args:
            values: (n participants, k conditions) complete values of the declared measure.
            levels: keys of the conditions, by ascending added latency.
            labels: what the outcome calls them, all different; their keys by default.

        Raises:
            StatisticsError: the values do not allow the test.
        """
        primary = self.primary
        names = dict(zip(levels, levels, strict=True)) | dict(labels or {})
        sample = Sample(
            values=values,
            levels=tuple(names[level] for level in levels),
            direction=primary.direction,
            reference=None if primary.reference is None else names[primary.reference],
            holm=primary.correction == "holm",
            alpha=self.alpha,
        )
        return statistical_test(primary.test).load()(sample)

    def is_met_by(self, outcome: Outcome) -> bool:
        """Return whether an outcome of the test is significant at the declared level."""
        return outcome.p <= self.alpha

    @model_validator(mode="after")
    def _rules_once(self) -> Self:
        rules = [one.rule for one in self.exclusions]
        for at, rule in enumerate(rules):
            if rule in rules[:at]:
                raise refusal(
                    f"The rule {rule} is listed twice.",
                    value=rule,
                    valid="every rule once",
                    remedy="Keep one of them.",
                    at=("exclusions", at, "rule"),
                )
        return self


def preregistration_problems(
    tree: Mapping[str, Plain], instruments: Mapping[str, Instrument]
) -> Iterator[DefinitionProblem]:
    """Yield the problems of a preregistration.

    These are a measure not asked after the task, and unknown scores, limbs or references.
    """
    primary = _dict(_dict(tree.get("preregistration")).get("primary"))
    if not primary:
        return
    phases = [_dict(one) for one in _list(_dict(_block(tree)).get("phases"))]
    yield from _limb(primary, phases)
    yield from _score(primary, phases, instruments)
    yield from _conditions(primary, tree)


def _limb(primary: dict[str, Plain], phases: list[dict[str, Plain]]) -> Iterator[DefinitionProblem]:
    limb = primary.get("limb")
    limbs = sorted({str(one.get("limb")) for one in phases})
    if isinstance(limb, str) and limb in ("hand", "foot") and limb not in limbs:
        yield DefinitionProblem(
            (*_PRIMARY, "limb"),
            f"The study has no task with the {limb}.",
            limb,
            limbs,
            f"Use one of: {', '.join(limbs)}.",
        )
    if limb == "both" and len(limbs) == 1:
        yield DefinitionProblem(
            (*_PRIMARY, "limb"),
            "The study has tasks with one limb only.",
            limb,
            limbs,
            f"Say {limbs[0]}.",
        )


def _score(
    primary: dict[str, Plain],
    phases: list[dict[str, Plain]],
    instruments: Mapping[str, Instrument],
) -> Iterator[DefinitionProblem]:
    key, score = primary.get("instrument"), primary.get("score")
    if not isinstance(key, str):
        return
    tasks = [one for one in phases if primary.get("limb") in (one.get("limb"), "both")]
    instrument_keys = sorted({str(one.get("questionnaire")) for one in tasks})
    if tasks and instrument_keys != [key]:
        yield DefinitionProblem(
            (*_PRIMARY, "instrument"),
            f"{key!r} is not the instrument asked after the task.",
            key,
            instrument_keys,
            f"Use one of: {', '.join(instrument_keys)}.",
        )
    score_keys = [one.key for one in instruments[key].scores] if key in instruments else []
    if score_keys and isinstance(score, str) and score not in score_keys:
        yield DefinitionProblem(
            (*_PRIMARY, "score"),
            f"The instrument {key!r} has no score {score!r}.",
            score,
            score_keys,
            f"Use one of: {', '.join(score_keys)}.",
        )


def _conditions(
    primary: dict[str, Plain], tree: Mapping[str, Plain]
) -> Iterator[DefinitionProblem]:
    keys = [str(_dict(one).get("key")) for one in _list(tree.get("conditions"))]
    reference, test = primary.get("reference"), primary.get("test")
    if isinstance(reference, str) and reference not in keys:
        yield DefinitionProblem(
            (*_PRIMARY, "reference"),
            f"There is no condition {reference!r}.",
            reference,
            keys,
            f"Use one of: {', '.join(keys)}.",
        )
    by_key = {one.key: one for one in TESTS}
    needed = by_key[test].fewest_conditions if isinstance(test, str) and test in by_key else 0
    # Every test needs two; another test would not help a study with one condition.
    if needed > _FEWEST and 0 < len(keys) < needed:
        possible = sorted(
            one.key for one in TESTS if one.fewest_conditions <= max(len(keys), _FEWEST)
        )
        yield DefinitionProblem(
            (*_PRIMARY, "test"),
            f"The test {test} needs {_COUNTS.get(needed, needed)} conditions; the study has "
            f"{len(keys)}.",
            test,
            possible,
            f"Use one of: {', '.join(possible)}.",
        )


def _block(tree: Mapping[str, Plain]) -> Plain:
    return _dict(tree.get("procedure")).get("block")


def _dict(value: Plain) -> dict[str, Plain]:
    return value if isinstance(value, dict) else {}


def _list(value: Plain) -> list[Plain]:
    return value if isinstance(value, list) else []
