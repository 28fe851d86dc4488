"""Tests of partners in their own process: equal bytes despite delays, and every way to be lost."""

import time
from pathlib import Path

import numpy as np
import pytest

from app.adapters.cosimulation import ProcessPartner, ProcessPlan
from app.science.cosimulation import (
    Clocks,
    Conductor,
    Lateness,
    Partner,
    Record,
    RecordedPath,
    Road,
)
from tests.adapters.cosimulation import protocol_partner

STEP_S = 0.02
SCRIPT = str(Path(protocol_partner.__file__))


WAITING = Lateness()


def _run(seed: int, fault: str = "none", lateness: Lateness = WAITING) -> Record:
    command = ("{python}", SCRIPT, "{address}", "other", str(seed), fault)
    plan = ProcessPlan("other", STEP_S, command)
    times, xy_m = np.array([0.0, 2.0]), np.array([[0.0, -5.0], [30.0, -5.0]])
    process = ProcessPartner(plan, Road(), seed=7)
    try:
        together: list[tuple[Partner, Lateness]] = [
            (RecordedPath("p", STEP_S, times, xy_m), Lateness()),
            (process, lateness),
        ]
        return Conductor(together, STEP_S, Clocks(time.perf_counter)).run(60, {})[0]
    finally:
        process.close()


def test_a_slow_process_that_is_waited_for_changes_no_byte() -> None:
    """With and without random delays, the process and the scene give the same record."""
    quick, slow = _run(seed=0), _run(seed=5)
    assert not quick.lost
    assert len(quick.steps) == 61
    assert slow.content == quick.content


def test_a_slow_process_may_be_extrapolated() -> None:
    """Answers after the patience are guessed, and each guess has what came later beside it."""
    record = _run(seed=5, lateness=Lateness("extrapolate", patience_s=0.0, at_most_s=0.1))
    assert not record.lost
    assert record.guesses
    known = [one for one in record.guesses if one.came is not None]
    # At 0.5 m/s it is guessed 1 cm ahead a step, and it goes 1 cm ahead or back.
    assert len(known) >= len(record.guesses) - 5
    assert all(one.error_m is not None and one.error_m < 0.11 for one in known)


@pytest.mark.parametrize(
    ("fault", "reason", "steps"),
    [
        ("dies", "'other' has closed its connection", 20),
        ("misspells", "'other' said something that is not valid: actors.0.speed_m_s: Field", 20),
        ("hangs", "'other' did not answer for 0.5 s; its last state is of 0.38 s.", 20),
        ("token", "'other' ended with exit code 0 before it connected.", 0),
    ],
)
def test_a_lost_process_ends_the_run_and_keeps_the_record(
    fault: str, reason: str, steps: int
) -> None:
    """Killed, misspeaking, hanging or unknown: the reason is named, and all states are kept."""
    record = _run(seed=0, fault=fault, lateness=Lateness(give_up_s=0.5))
    assert record.lost.startswith(reason)
    assert len(record.steps) == steps


def test_a_process_that_never_comes_or_does_not_exist_is_named() -> None:
    """Nobody connects in time; a program that is not there."""
    for command, reason in (
        ((), "'x' did not connect to 127.0.0.1:"),
        (("/no/such/program",), "'x' cannot be started: /no/such/program: No such file"),
    ):
        plan = ProcessPlan("x", STEP_S, command, connect_s=0.3)
        partner = ProcessPartner(plan, Road(), seed=1)
        record = Conductor([(partner, Lateness())], STEP_S, Clocks(time.perf_counter)).run(5, {})[0]
        partner.close()
        assert record.lost.startswith(reason)
        assert record.steps == ()
