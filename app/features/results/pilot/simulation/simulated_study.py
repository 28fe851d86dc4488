"""Simulate the data sets of a study, and test each as its preregistration declares.

The forms are scored by the instrument's own formulas, straight-lined ones are found by the rule
that excludes people's sessions, and the test is the one that runs on people's data: nothing of the
analysis is written a second time here.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from app.features.results.pilot.order import PilotError
from app.features.results.pilot.simulation.plan import Chunk, conditions_of, slots_of
from app.protocol import (
    Answering,
    Assumptions,
    Performance,
    StudyProtocol,
    declared_analysis,
)
from app.science.instruments import Instrument, scores_of_columns, straight_lined
from app.science.pilot import (
    Course,
    GradedItem,
    Results,
    drawn_courses,
    drawn_ratings,
    drawn_visits,
)
from app.science.statistics import FloatArray, StatisticsError

BoolArray = NDArray[np.bool_]
_ASSUMED_PEOPLE: Final = 40_000
"""People from whose answers the assumed difference is computed; its error is far below theirs."""


class SimulatedStudy:
    """A study with its assumptions, from which data sets are drawn and tested.

    Raises:
        PilotError: neither the study nor the assumptions declare a test.
    """

    def __init__(
        self, study: StudyProtocol, assumptions: Assumptions, instruments: Mapping[str, Instrument]
    ) -> None:
        declared = declared_analysis(study, assumptions)
        if declared is None:
            raise PilotError(f"the study {study.key} declares no test")
        self.declared = declared
        self._study, self._given = study, assumptions
        self._keys = conditions_of(study)
        primary = declared.primary
        phases = study.procedure.block.phases
        self._answering: Answering | None = None
        if primary.measure == "score":
            self._answering = assumptions.answering
            assert self._answering is not None  # noqa: S101 - the loaded file was checked
            # Every form counts for straight-lining, also those of the limb that is not tested.
            key = self._answering.instrument
            limbs = [one.limb for one in phases if one.questionnaire == key]
            self._instrument = instruments[key]
            self._items = _graded(self._answering, self._instrument)
            self._course = _course_of_traits(self._answering, limbs, self._keys)
        else:
            limbs = [one.limb for one in phases if primary.limb in (one.limb, "both")]
            performance = assumptions.performance[primary.measure]
            self._course = _course_of_values(performance, limbs, self._keys)
        self._tested_limbs = [at for at, limb in enumerate(limbs) if primary.limb in (limb, "both")]
        rules = {rule.rule: rule for rule in declared.exclusions}
        straight = rules.get("maximum_straight_lined_forms")
        self._most_straight = None if straight is None else straight.limit

    def assumed_difference(self, seed: int) -> float:
        """Return the difference of the measure between the longest and the shortest latency.

        It is what the assumptions say of people whom nothing disturbs: without carry-over, period,
        straight-lining and drop-out. Its sign is that of the measure as latency increases.
        """
        rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(0,)))
        orders = np.tile(np.arange(len(self._keys)), (1, _ASSUMED_PEOPLE, 1))
        levels = drawn_courses(self._course.undisturbed(), orders, rng)
        means = self._of_tasks(self._measured(levels, rng, 0.0)[0])[0].mean(axis=0)
        return float(means[-1] - means[0])

    def tested(self, chunk: Chunk, seed: int) -> Results:
        """Draw the data sets of a chunk and test each of them."""
        values, kept = self.data_sets(chunk, seed)
        results = [self._test(one[keep]) for one, keep in zip(values, kept, strict=True)]
        significant, failed, estimates, in_test = zip(*results, strict=True)
        return Results(
            np.array(significant), np.array(failed), np.array(estimates), np.array(in_test)
        )

    def data_sets(self, chunk: Chunk, seed: int) -> tuple[FloatArray, BoolArray]:
        """Return the declared measure (sets, n, k), and who is in the test (sets, n)."""
        rng, given = chunk.rng(seed), self._given
        slots = slots_of(self._study, chunk.n)
        visits = drawn_visits(slots, chunk.sets, chunk.n, given.dropout.value, rng)
        excluded = rng.random((chunk.sets, chunk.n)) < given.excluded.value
        course = self._course if chunk.scenario == "effect" else self._course.without_effect()
        lining = self._answering.straight_lining.value if self._answering is not None else 0.0
        values, straight = self._measured(drawn_courses(course, visits.orders, rng), rng, lining)
        kept = visits.completed & ~excluded
        if self._most_straight is not None:
            kept &= straight.sum(axis=(2, 3)) <= self._most_straight
        means = self._of_tasks(values)
        return means, kept & np.isfinite(means).all(axis=2)

    def _of_tasks(self, values: FloatArray) -> FloatArray:
        """Return the mean of everybody's tested tasks; without one of them there is none."""
        means: FloatArray = values[:, :, self._tested_limbs].mean(axis=2)
        return means

    def _test(self, values: FloatArray) -> tuple[bool, bool, float, int]:
        """Return whether a test is significant or failed, the difference, and the participants."""
        n = len(values)
        difference = float((values[:, -1] - values[:, 0]).mean()) if n else float("nan")
        try:
            outcome = self.declared.outcome_of(values, self._keys)
        except StatisticsError:
            return False, True, difference, n
        if not np.isfinite(outcome.p):
            return False, True, difference, n
        return self.declared.is_met_by(outcome), False, difference, n

    def _measured(
        self, levels: FloatArray, rng: np.random.Generator, lining: float
    ) -> tuple[FloatArray, BoolArray]:
        """Return the measure of levels (sets, n, limbs, k), and which forms were straight-lined."""
        if self._answering is None:
            values = np.maximum(levels, 0.0)
            whole = self.declared.primary.measure == "completions"
            return np.rint(values) if whole else values, np.zeros(levels.shape, dtype=np.bool_)
        ratings = {item.key: drawn_ratings(item, levels, rng) for item in self._items}
        lined = rng.random(levels.shape) < lining
        place = rng.random(levels.shape)
        for item in self._items:
            # The same place on every item's scale: with one scale, the same rating.
            scale = np.asarray(item.ratings, dtype=np.float64)
            same = scale[(place * scale.size).astype(np.int64)]
            ratings[item.key] = np.where(lined, same, ratings[item.key])
        columns = {key: column.ravel() for key, column in ratings.items()}
        scores = scores_of_columns(self._instrument, columns, rows=levels.size)
        score = scores[self.declared.primary.score or ""].reshape(levels.shape)
        one_sided = not any(item.reverse_keyed for item in self._instrument.items)
        together = np.stack(list(ratings.values()), axis=-1)
        return score, straight_lined(together, one_sided=one_sided)


def _graded(given: Answering, instrument: Instrument) -> list[GradedItem]:
    items = []
    for item in instrument.items:
        scale = item.scale or instrument.scale
        if item.type != "likert" or scale is None:
            continue
        own = given.items.get(item.key)
        thresholds = (own and own.thresholds) or given.thresholds
        discrimination = (own and own.discrimination) or given.discrimination
        items.append(
            GradedItem(
                item.key,
                tuple(scale.steps),
                thresholds.values,
                discrimination.value,
                -1 if item.reverse_keyed else 1,
            )
        )
    return items


def _course_of_traits(given: Answering, limbs: Sequence[str], keys: tuple[str, ...]) -> Course:
    effects = np.array([[given.effects[key].value for key in keys]] * len(limbs))
    shifts: dict[str, float] = {limb: one.value for limb, one in given.limbs.items()}
    return Course(
        means=effects + np.array([[shifts.get(limb, 0.0)] for limb in limbs]),
        effects=effects,
        carry_over=given.carry_over.value,
        period=given.period.value,
        persons=given.persons.value,
        reactions=given.reactions.value,
        moments=given.moments.value,
    )


def _course_of_values(given: Performance, limbs: Sequence[str], keys: tuple[str, ...]) -> Course:
    by_limb = {str(limb): own for limb, own in given.means.items()}
    means = np.array([[by_limb[limb][key].value for key in keys] for limb in limbs])
    return Course(
        means=means,
        # The shortest latency is the condition without an effect.
        effects=means - means[:, :1],
        carry_over=given.carry_over.value,
        period=given.period.value,
        persons=given.persons.value,
        reactions=given.reactions.value,
        moments=given.moments.value,
    )
