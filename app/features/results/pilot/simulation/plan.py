"""What a pilot computes, in pieces that any process can compute alone and in any order.

A chunk is some data sets of one number of participants, with the assumed effect or without it. Its
random numbers depend on the seed and on what the chunk is, and on nothing else, so how chunks are
shared out changes no number.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from app.features.results.pilot.order import MOST_SETS, PilotError, require_numbers
from app.protocol import LoadedStudy, Preregistration, StudyProtocol, ledger_block, sequences
from app.science.instruments import Instrument
from app.science.statistics import IntArray, StatisticsError

CHUNK_SETS: Final = 50
"""Data sets of a chunk; another number would change every result."""
Scenario = Literal["effect", "null"]
SCENARIOS: Final[tuple[Scenario, ...]] = ("effect", "null")


@dataclass(frozen=True)
class PilotStudy:
    """A study with the instruments that it asks."""

    study: LoadedStudy
    instruments: Mapping[str, Instrument]


@dataclass(frozen=True)
class Sharing:
    """How the work is shared out.

    `workers`: processes. `shard`: the number of this part, from 0, and of all parts.
    """

    workers: int = 1
    shard: tuple[int, int] = (0, 1)


@dataclass(frozen=True)
class Progress:
    """How far a stage of a pilot is: bodies that are checked, people, or parts of a power curve."""

    stage: Literal["check", "people", "power"]
    done: int
    total: int


def missing_shards(total: int, present: Collection[int]) -> tuple[str, ...]:
    """Name the shards that are missing, as in 2/3, of work that is shared out by position.

    Empty if nothing is missing, or if no whole shards are.
    """
    missing = {at for at in range(total) if at not in present}
    for parts in range(2, total + 1):
        gone = [part for part in range(parts) if missing.issuperset(range(part, total, parts))]
        if missing and sum(len(range(part, total, parts)) for part in gone) == len(missing):
            return tuple(f"{part + 1}/{parts}" for part in gone)
    return ()


Tell = Callable[[Progress], None]
"""Is told how far a pilot is, often."""


@dataclass(frozen=True)
class Chunk:
    """Some of a pilot's data sets: `sets` of them, each with `n` participants."""

    n: int
    scenario: Scenario
    index: int
    sets: int

    def rng(self, seed: int) -> np.random.Generator:
        """Return the chunk's own random generator."""
        spawned = (self.n, SCENARIOS.index(self.scenario), self.index)
        return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=spawned))


@dataclass(frozen=True)
class PilotPlan:
    """What is computed.

    Attributes:
        participants: numbers of people who start, ascending.
        sets: data sets for each of them, as many with the effect as without.
        seed: of all random numbers.
    """

    participants: tuple[int, ...]
    sets: int
    seed: int


def make_plan(study: StudyProtocol, participants: Sequence[int], sets: int, seed: int) -> PilotPlan:
    """Check what is asked; raises PilotError."""
    wanted = require_numbers(study, participants)
    if not 1 <= sets <= MOST_SETS:
        raise PilotError(
            f"{sets} data sets: 1 to {MOST_SETS} are valid; 500 give bands of 4.5 points"
        )
    if seed < 0:
        raise PilotError(f"a seed of {seed} is not possible; give 0 or a greater number")
    return PilotPlan(wanted, sets, seed)


def chunks_of(plan: PilotPlan) -> Iterator[Chunk]:
    """Yield every chunk of a plan, the fewest participants first."""
    for n in plan.participants:
        for scenario in SCENARIOS:
            for index, start in enumerate(range(0, plan.sets, CHUNK_SETS)):
                yield Chunk(n, scenario, index, min(CHUNK_SETS, plan.sets - start))


def slots_of(study: StudyProtocol, n: int) -> IntArray:
    """Return the first n slots of the study's own ledger: (n, k) numbers of conditions.

    Conditions are numbered by ascending added latency.
    """
    keys = conditions_of(study)
    blocks = -(-n // len(sequences(study)))
    rows = [row.sequence for block in range(blocks) for row in ledger_block(study, block)]
    return np.array([[keys.index(key) for key in row] for row in rows[:n]], dtype=np.int64)


def conditions_of(study: StudyProtocol) -> tuple[str, ...]:
    """Return the conditions by ascending added latency, as the primary test has them."""
    return tuple(one.key for one in sorted(study.conditions, key=lambda one: one.latency_ms))


def lowest_p(study: StudyProtocol, declared: Preregistration, n: int) -> float | None:
    """Return the p of data in which everybody shows a huge effect; None if no p can be computed.

    For tests on ranks it is the lowest p that n participants can give.
    """
    keys = conditions_of(study)
    rising = np.arange(len(keys), dtype=np.float64)
    # A share of the effect that differs between people, so that differences are not all the same.
    shares = 100.0 + np.linspace(0.0, 1.0, n)[:, np.newaxis]
    sign = -1.0 if declared.primary.direction == "falls" else 1.0
    try:
        return declared.outcome_of(sign * shares * rising, keys).p
    except StatisticsError:
        return None
