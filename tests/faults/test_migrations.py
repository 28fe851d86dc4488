"""A migration that is interrupted anywhere leaves the old schema or the new one, with all data.

Fault 28 of the matrix. Every revision there is takes part, also those that are added later.
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
"""Revisions that labs have run: they never change, and are stopped at in the long form."""
EVERY = steps()
STEPS = [
    pytest.param(step, marks=pytest.mark.long if step[-1] in RELEASED else ()) for step in EVERY
]
KILLS, MANY_KILLS = 4, 60
STOPS_ON_POSTGRES = 6
"""PostgreSQL is slow to copy; the long form stops at every statement there too."""


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def bench(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """Where databases are made."""
    if request.param == "sqlite":
        return SqliteBench(tmp_path_factory.mktemp("bench"))
    return PostgresBench(running_cluster())


@dataclass(frozen=True)
class Known:
    """A filled database before a step, and what it is before and after, undisturbed."""

    url: str
    old: Found
    new: Found
    changes: int
    took_s: float


@contextmanager
def undisturbed(bench: Bench, step: Step) -> Iterator[Known]:
    """Take the step once on a copy."""
    before, after = step
    with bench.empty() as url:
        upgrade(url, before)
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
def known_of(bench: Bench) -> Iterator[Callable[[Step], Known]]:
    """What is known of a step: each is taken once for all tests, which only copy the database."""
    with ExitStack() as stack:
        yield cache(lambda step: stack.enter_context(undisturbed(bench, step)))


@pytest.mark.parametrize("step", STEPS, ids="-".join)
def test_a_step_stopped_at_a_statement_can_be_taken_again(
    bench: Bench, known_of: Callable[[Step], Known], step: Step
) -> None:
    """Behind every statement and instead of the commit: the old schema; then the new one."""
    most = None if isinstance(bench, SqliteBench) else STOPS_ON_POSTGRES
    stop_often(bench, step, known_of(step), most)


@pytest.mark.long
@pytest.mark.parametrize("step", STEPS, ids="-".join)
def test_a_step_stopped_at_every_statement_on_postgresql(step: Step) -> None:
    """The same without leaving any out."""
    bench = PostgresBench(running_cluster())
    with undisturbed(bench, step) as known:
        stop_often(bench, step, known, None)


def stop_often(bench: Bench, step: Step, known: Known, most: int | None) -> None:
    """Stop behind each statement, or behind so many of them evenly spread; the last always."""
    stops = np.unique(np.linspace(1, known.changes, most or known.changes, dtype=int)).tolist()
    assert stops[-1] == known.changes > 1
    for changes in stops:
        with bench.copy(known.url) as url:
            with pytest.raises(Interrupted), stopped_after(changes):
                upgrade(url, step[1])
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
    """How many statements of how many."""
    return f"{len(stops)} of {known.changes}"


def engine_of(bench: Bench) -> str:
    """Its name, for a figure."""
    return type(bench).__name__.removesuffix("Bench")


@pytest.mark.parametrize("step", STEPS, ids="-".join)
def test_a_step_keeps_every_row(known_of: Callable[[Step], Known], step: Step) -> None:
    """What both schemas know is the same before and after."""
    known = known_of(step)
    for table, rows in known.old.contents.items():
        now = known.new.contents.get(table)
        if now is None:
            continue
        shared = rows[0].keys() & now[0].keys()
        assert [{name: row[name] for name in shared} for row in now] == [
            {name: row[name] for name in shared} for row in rows
        ]


def test_a_killed_migration_can_be_taken_again(bench: Bench) -> None:
    """SIGKILL at random moments of the way from the first revision to the newest."""
    kill_often(bench, KILLS)


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_a_migration_killed_many_times(bench: Bench) -> None:
    """The same at many more moments."""
    kill_often(bench, MANY_KILLS)


def kill_often(bench: Bench, kills: int) -> None:
    """Start, kill, look, go on; the moments are drawn from a seed."""
    rng = np.random.default_rng(28)
    step = (EVERY[0][1], EVERY[-1][1])
    outcomes = {"old": 0, "new": 0}
    with undisturbed(bench, step) as known:
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
