"""Tests that an interrupted migration leaves the old schema or the new one, with all data.

Fault 28 of the matrix. Every existing revision takes part, also those that are added later.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from app.database import open_database
from tests.faults.bench import Bench, PostgresBench, SqliteBench
from tests.faults.figures import note
from tests.faults.interrupted import (
    Found,
    Interrupted,
    Step,
    counted,
    found,
    killed_after,
    steps,
    stopped_after,
    upgrade,
)
from tests.support.filled import fill
from tests.support.postgres import running_cluster

RELEASED = ("0001", "0002", "0003", "0004", "0005", "0006", "0007", "0008")
"""Revisions that labs have run: they never change, and are tested in the long form."""
EVERY = steps()
STEPS = [
    pytest.param(step, marks=pytest.mark.long if step[-1] in RELEASED else ()) for step in EVERY
]
KILLS, MANY_KILLS = 4, 60
STOPS_ON_POSTGRES = 6
"""PostgreSQL databases are slow to copy; the long form stops at every statement."""


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def bench(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """Provide the place where databases are created, for each engine."""
    if request.param == "sqlite":
        return SqliteBench(tmp_path_factory.mktemp("bench"))
    return PostgresBench(running_cluster())


@dataclass(frozen=True)
class Known:
    """A filled database before a step, and its state before and after an undisturbed run."""

    url: str
    old: Found
    new: Found
    changes: int
    took_s: float


class Ladder:
    """An empty database of each revision that was needed so far, each a copy of the one before."""

    def __init__(self, bench: Bench, stack: ExitStack) -> None:
        self.bench = bench
        self._stack = stack
        self._urls: dict[str, str] = {}
        self._before = {after: before for before, after in EVERY}

    def at(self, revision: str) -> str:
        """Return the URL of the empty database of this revision, with its connections closed."""
        if revision not in self._urls:
            before = self._before[revision]
            place = self.bench.empty() if before == "base" else self.bench.copy(self.at(before))
            url = self._stack.enter_context(place)
            upgrade(url, revision)
            self._urls[revision] = url
        return self._urls[revision]

    @contextmanager
    def rung(self, revision: str) -> Iterator[str]:
        """Yield the URL of a database of this revision that the caller may change."""
        place = self.bench.empty() if revision == "base" else self.bench.copy(self.at(revision))
        with place as url:
            yield url


@contextmanager
def undisturbed(ladder: Ladder, step: Step) -> Iterator[Known]:
    """Run the step once, undisturbed, on a copy of a filled database."""
    before, after = step
    bench = ladder.bench
    with ladder.rung(before) as url:
        database = open_database(url)
        fill(database.engine)
        database.close()
        old = found(url)
        with bench.copy(url) as copy:
            began_s = time.monotonic()
            with counted() as changes:
                upgrade(copy, after)
            took_s = time.monotonic() - began_s
            new = found(copy)
        yield Known(url, old, new, len(changes), took_s)


@pytest.fixture(scope="module")
def ladder(bench: Bench) -> Iterator[Ladder]:
    """Provide empty databases of every revision, made once for all tests."""
    with ExitStack() as stack:
        yield Ladder(bench, stack)


@pytest.fixture(scope="module")
def known_of(ladder: Ladder) -> Iterator[Callable[[Step], Known]]:
    """Provide the undisturbed result of each step, computed once for all tests."""
    with ExitStack() as stack:
        yield cache(lambda step: stack.enter_context(undisturbed(ladder, step)))


@pytest.mark.parametrize("step", STEPS, ids="-".join)
def test_a_step_stopped_at_a_statement_can_be_retried(
    bench: Bench, known_of: Callable[[Step], Known], step: Step
) -> None:
    """A step stopped after a statement or before the commit leaves the old schema for a retry."""
    most = None if isinstance(bench, SqliteBench) else STOPS_ON_POSTGRES
    stop_often(bench, step, known_of(step), most)


@pytest.mark.long
@pytest.mark.parametrize("step", STEPS, ids="-".join)
def test_a_step_stopped_at_every_statement_on_postgresql(step: Step) -> None:
    """On PostgreSQL, a step stopped after any statement keeps the old schema and can be retried."""
    bench = PostgresBench(running_cluster())
    with ExitStack() as stack, undisturbed(Ladder(bench, stack), step) as known:
        stop_often(bench, step, known, None)


def stop_often(bench: Bench, step: Step, known: Known, most: int | None) -> None:
    """Stop the step after each statement, or after `most` evenly spread ones including the last."""
    stops = np.unique(np.linspace(1, known.changes, most or known.changes, dtype=int)).tolist()
    assert stops[-1] == known.changes > 1
    with bench.copy(known.url) as url:
        # Each stop but the first is also the retry of the one before it.
        for changes in stops:
            with pytest.raises(Interrupted), stopped_after(changes) as seen:
                upgrade(url, step[1])
            assert len(seen) >= changes
            assert found(url) == known.old
        upgrade(url, step[1])
        assert found(url) == known.new
    note(
        28,
        f"{engine_of(bench)}, {' to '.join(step)}",
        "stopped at statements",
        of_all(stops, known),
    )
    note(28, f"{engine_of(bench)}, {' to '.join(step)}", "unusable", 0)


def of_all(stops: list[int], known: Known) -> str:
    """Format how many of the step's statements were tried, of how many."""
    return f"{len(stops)} of {known.changes}"


def engine_of(bench: Bench) -> str:
    """Return the engine's name as it is printed in a figure."""
    return type(bench).__name__.removesuffix("Bench")


@pytest.mark.parametrize("step", STEPS, ids="-".join)
def test_a_step_keeps_every_row(known_of: Callable[[Step], Known], step: Step) -> None:
    """A step changes no value of a row in columns that both schemas have."""
    known = known_of(step)
    for table, rows in known.old.contents.items():
        now = known.new.contents.get(table)
        if now is None:
            continue
        shared = rows[0].keys() & now[0].keys()
        assert [{name: row[name] for name in shared} for row in now] == [
            {name: row[name] for name in shared} for row in rows
        ]


def test_a_killed_migration_can_be_retried(ladder: Ladder) -> None:
    """A migration from the first revision to the newest can be retried after a SIGKILL."""
    kill_often(ladder, KILLS)


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_a_migration_killed_many_times_can_be_retried(ladder: Ladder) -> None:
    """A migration can be retried after each of many SIGKILLs at random moments."""
    kill_often(ladder, MANY_KILLS)


def kill_often(ladder: Ladder, kills: int) -> None:
    """Kill migrations at moments drawn from a seed, check the database, and retry."""
    bench = ladder.bench
    rng = np.random.default_rng(28)
    step = (EVERY[0][1], EVERY[-1][1])
    outcomes = {"old": 0, "new": 0}
    with undisturbed(ladder, step) as known:
        for _ in range(kills):
            with bench.copy(known.url) as url:
                killed = killed_after(url, step[1], float(rng.uniform(0.0, 2 * known.took_s)))
                now = found(url)
                assert now in (known.old, known.new)
                assert killed or now == known.new
                outcomes["old" if now == known.old else "new"] += 1
                upgrade(url, step[1])
                assert found(url) == known.new
    note(28, f"{engine_of(bench)}, killed", "schemas found", outcomes)
    note(28, f"{engine_of(bench)}, killed", f"unusable of {kills}", 0)
