"""Run `reembody reach`: fit how people reach, evaluate it, and draw from it."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from app.adapters.reaching_file import is_reaching, read_reaching, write_reaching
from app.cli.outputs import require_output, require_replaceable
from app.cli.reach.inputs import HandsOrder, RecordedReaches, read_reaches
from app.science.reaching import (
    FittedReaching,
    NoReach,
    ReachEvaluation,
    ReachFitOptions,
    ReachRules,
    evaluate_reaching,
    fitted_reaching,
    reach_database,
)
from app.science.rotations import FloatArray

FARTHEST_M: Final = 3.0
USUAL_WIDTH_M: Final = 0.1


@dataclass(frozen=True, eq=False)
class FittedFile:
    """A model that was fitted and written.

    Attributes:
        left_out: all movements that were not used.
    """

    out: Path
    fit: FittedReaching
    recorded: RecordedReaches
    left_out: tuple[NoReach, ...]


@dataclass(frozen=True)
class SampleOrder:
    """The options of `reach sample`."""

    model: Path
    distance_m: float
    width_m: float | None
    count: int
    seed: int


@dataclass(frozen=True, eq=False)
class SampledReaches:
    """Draws of new people: whole times (count,) and skews (count,)."""

    order: SampleOrder
    fit: FittedReaching
    durations_s: FloatArray
    skews: FloatArray

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be known before these draws are believed."""
        found, order = [], self.order
        if self.fit.outside(order.distance_m):
            least_m, most_m = self.fit.distances_m
            found.append(
                f"{order.distance_m:g} m is outside of the recorded distances, {least_m:.2f} to"
                f" {most_m:.2f} m: this is a guess"
            )
        if order.width_m is not None and not self.fit.by_width:
            found.append(
                "the widths of the recorded targets are not known: --width changes nothing"
            )
        return tuple(found)


def carry_out_fit(
    order: HandsOrder, out: Path, seed: int, now: Callable[[str], None]
) -> FittedFile:
    """Fit a model and write it; raise ValueError or OSError, with nothing written.

    `now` is told what is being done, in words.
    """
    require_output(out, *order.files, order.people)
    require_replaceable(out, "a file of how people reach", is_reaching)
    rules = ReachRules()
    recorded = read_reaches(order, rules)
    now(f"making the maps of {len(recorded.reaches)} reaches")
    database, beyond = reach_database(recorded.reaches, rules)
    now("comparing readings of the maps")
    fit = fitted_reaching(database, rules, ReachFitOptions(seed=seed))
    written = write_reaching(out, fit)
    return FittedFile(out, written, recorded, (*recorded.left_out, *beyond))


def carry_out_evaluation(
    model: Path, draws: int, seed: int
) -> tuple[FittedReaching, ReachEvaluation]:
    """Leave out one person (or recording) after the other; raise ValueError or OSError."""
    fit = read_reaching(model)
    return fit, evaluate_reaching(fit, seed, draws)


def carry_out_sample(order: SampleOrder) -> SampledReaches:
    """Draw from a model; raise ValueError or OSError."""
    if not 0.01 <= order.distance_m <= FARTHEST_M:
        raise ValueError(
            f"--distance {order.distance_m:g}: 0.01 to {FARTHEST_M:g} m are valid; give metres"
        )
    width_m = USUAL_WIDTH_M if order.width_m is None else order.width_m
    if not 0.001 <= width_m <= 2.0:
        raise ValueError(f"--width {width_m:g}: 0.001 to 2 m are valid; give metres")
    fit = read_reaching(order.model)
    rng = np.random.default_rng(order.seed)
    durations_s, skews = fit.movements(order.distance_m, width_m / 2.0, order.count, rng)
    return SampledReaches(order, fit, durations_s, skews)
