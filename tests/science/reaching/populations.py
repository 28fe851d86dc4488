"""Print how well reaching is predicted of synthetic populations: the table of docs/reaching.md.

python -m tests.science.reaching.populations
"""

import sys
from dataclasses import dataclass

import numpy as np

from app.science.reaching import (
    Reach,
    Reacher,
    ReachEvaluation,
    ReachRules,
    evaluate_reaching,
    fitted_reaching,
    reach_database,
    reaches_of,
)
from tests.science.reaching.reachers import Planted, hand_of

PEOPLE, REACHES = 10, 15


@dataclass(frozen=True)
class Population:
    """People with planted tempos.

    Attributes:
        name: in the table.
        tempo: median of people's tempos.
        between, within: SDs of the logarithm of tempo, between people and of one's reaches.
        skew: of all movements.
    """

    name: str
    tempo: float
    between: float
    within: float
    skew: float


POPULATIONS = (
    Population("as assumed", 1.0, 0.15, 0.08, 1.0),
    Population("slower", 1.5, 0.15, 0.1, 1.3),
    Population("twice as slow", 2.0, 0.25, 0.12, 1.5),
    Population("quick", 0.8, 0.15, 0.08, 0.8),
    Population("mixed", 1.3, 0.3, 0.15, 1.2),
)


def reaches_in(population: Population) -> list[Reach]:
    """Return the reaches of all people of a population."""
    found: list[Reach] = []
    for number in range(PEOPLE):
        rng = np.random.default_rng((11, number, len(population.name)))
        tempo = population.tempo * float(np.exp(population.between * rng.standard_normal()))
        planted = Planted(tempo, population.within, population.skew)
        who = Reacher(f"P{number}", str(number), "synthetic")
        found += reaches_of(hand_of(planted, who, rng, count=REACHES))[0]
    return found


def evaluated(population: Population) -> tuple[tuple[float, float], ReachEvaluation]:
    """Return the interval of the median tempo, and the scores of people left out."""
    rules = ReachRules()
    fit = fitted_reaching(reach_database(reaches_in(population), rules)[0], rules)
    return fit.levels.interval(), evaluate_reaching(fit)


def main() -> None:
    """Print a row for each population and each method."""
    for population in POPULATIONS:
        (low, high), found = evaluated(population)
        planted = f"planted {population.tempo:g}, found {low:.2f} to {high:.2f}"
        rows = [
            f"  {one.method:8} {one.crps_s:.4f}  {one.maps_better_s:+.3f} {_ends(one.interval_s)}"
            for one in found.scores
        ]
        sys.stdout.write("\n".join([f"{population.name}: {planted}", *rows]) + "\n")


def _ends(interval_s: tuple[float, float] | None) -> str:
    return "" if interval_s is None else f"[{interval_s[0]:+.3f}, {interval_s[1]:+.3f}]"


if __name__ == "__main__":
    main()
