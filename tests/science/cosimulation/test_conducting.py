"""Tests of the master clock: equal bytes, late partners, what partners get to see, refusals."""

import json
import time
from math import cos, inf, sin

import pytest

from app.science.cosimulation import (
    Clocks,
    Conductor,
    CosimulationError,
    Lateness,
    Partner,
    Record,
)
from tests.science.cosimulation.scripted import (
    Follower,
    Late,
    Scripted,
    TestClock,
    Threaded,
    delays,
    straight,
)

STEP_S = 0.02
GUESSING = Lateness("extrapolate", patience_s=0.02, at_most_s=0.2, give_up_s=5.0)


def _run(partners: list[tuple[Partner, Lateness]], steps: int, clocks: Clocks) -> Record:
    return Conductor(partners, STEP_S, clocks).run(steps, {"scene": "test"})[0]


def test_slow_partners_that_are_waited_for_change_no_byte() -> None:
    """Partners in threads with random delays give the record of those that answer at once."""
    quick: list[Partner] = [Scripted("a", straight), Follower("b", STEP_S), Follower("c", 0.06)]
    expected = _run([(one, Lateness()) for one in quick], 150, Clocks(time.perf_counter))
    for seed in (1, 2):
        slow: list[Partner] = [
            Threaded(one, delays(seed * 10 + number, 150))
            for number, one in enumerate(
                (Scripted("a", straight), Follower("b", STEP_S), Follower("c", 0.06))
            )
        ]
        found = _run([(one, Lateness()) for one in slow], 150, Clocks(time.perf_counter))
        assert found.content == expected.content
    assert not expected.lost
    assert len(expected.steps) == 151


def test_everybody_sees_the_others_at_the_step_s_beginning() -> None:
    """In whatever order partners stand, each gets all others at the same time, by name."""
    one, other = Scripted("a", straight), Scripted("z", straight)
    third = Scripted("m", straight)
    _run([(third, Lateness()), (other, Lateness()), (one, Lateness())], 3, TestClock().clocks())
    for partner, names in ((one, ["m", "z"]), (third, ["a", "z"]), (other, ["a", "m"])):
        assert [request.from_s for request in partner.asked] == [0.0, 0.02, 0.04]
        for request in partner.asked:
            assert [seen.name for seen in request.others] == names
            assert all(seen.time_s == request.from_s for seen in request.others)


def test_between_long_steps_others_see_interpolated_states() -> None:
    """A partner with a step of 0.1 s is seen every 0.02 s, marked as between two answers."""
    seer = Scripted("b", straight)
    slow = Scripted("a", lambda t: (t * t, 0.0, 2.0 * t, 0.0), step_s=0.1)
    record = _run([(slow, Lateness()), (seer, Lateness())], 10, TestClock().clocks())
    seen = [request.others[0].x_m for request in seer.asked]
    assert seen == pytest.approx([0, 0.002, 0.004, 0.006, 0.008, 0.01, 0.016, 0.022, 0.028, 0.034])
    origins = [rows[0].origin for rows in record.steps]
    assert origins == ["said", *["between"] * 4, "said", *["between"] * 4, "said"]
    assert len(slow.asked) == 2


def test_a_late_partner_is_extrapolated_and_every_guess_recorded() -> None:
    """Guesses keep speed and turn rate, and stand beside what the partner said later."""
    clock = TestClock()
    radius = 1.5 / 0.5

    def circle(t: float) -> tuple[float, float, float, float]:
        return radius * sin(0.5 * t), radius * (1.0 - cos(0.5 * t)), 1.5, 0.5

    def braking(t: float) -> tuple[float, float, float, float]:
        return 2.0 * t - t * t, 0.0, 2.0 - 2.0 * t, 0.0

    turning, seer = Scripted("turning", circle), Scripted("seer", straight)
    slowing = Scripted("slowing", braking)
    partners: list[tuple[Partner, Lateness]] = [
        (Late(turning, clock, {6: 0.07}), GUESSING),
        (Late(slowing, clock, {6: 0.07}), GUESSING),
        (seer, Lateness()),
    ]
    record = _run(partners, 30, clock.clocks())
    guesses = {
        name: [one for one in record.guesses if one.partner == name]
        for name in ("turning", "slowing")
    }
    assert len(record.guesses) == sum(
        row.origin == "guessed" for rows in record.steps for row in rows
    )
    for name, found in guesses.items():
        # Asked at 0.1 s, it answered 70 ms later: the states of 0.12 to 0.16 s were not there.
        assert [one.guessed.time_s for one in found] == [0.12, 0.14, 0.16], name
        assert all(one.said_s == 0.1 and one.came is not None for one in found)
    assert [one.error_m for one in guesses["turning"]] == pytest.approx([0, 0, 0], abs=1e-12)
    # With an acceleration of -2 m/s^2, the error after t is t^2.
    assert [one.error_m for one in guesses["slowing"]] == pytest.approx([0.0004, 0.0016, 0.0036])
    # The others acted upon the guesses, and it was told later what it had missed.
    seen = {r.from_s: r.others[0].x_m for r in seer.asked}
    assert seen[0.14] == guesses["slowing"][1].guessed.x_m
    assert [request.from_s for request in turning.asked] == [r.from_s for r in seer.asked]
    told = [json.loads(line) for line in record.lines() if line.startswith('{"partner"')]
    assert [one["error_m"] for one in told] == [one.error_m for one in record.guesses]


def test_extrapolation_ends_after_the_stated_time() -> None:
    """After 0.2 s of guesses the clock waits; a partner that never answers is lost, not the run."""
    clock = TestClock()
    record = _run([(Late(Scripted("a", straight), clock, {11: 1.0}), GUESSING)], 40, clock.clocks())
    assert not record.lost
    assert [one.guessed.time_s for one in record.guesses][-1] == pytest.approx(0.4)
    assert len(record.guesses) == 10

    for rule, last_s in ((GUESSING, 0.4), (Lateness("wait", give_up_s=5.0), 0.2)):
        clock = TestClock()
        partner = Late(Scripted("a", straight), clock, {11: inf})
        record = _run([(partner, rule)], 40, clock.clocks())
        assert record.lost == "'a' did not answer for 5 s; its last state is of 0.2 s."
        assert (len(record.steps) - 1) * STEP_S == pytest.approx(last_s)
        assert json.loads(list(record.lines())[-1])["ended"] == "partner lost"
        assert all(one.came is None for one in record.guesses)


def test_what_cannot_be_run_together_is_refused() -> None:
    """Steps that do not fit, two partners of one name, and two actors of one name are named."""
    clocks = TestClock().clocks()
    with pytest.raises(
        CosimulationError, match=r"'a' has a step of 0\.03 s; it must be a multiple"
    ):
        Conductor([(Scripted("a", straight, 0.03), Lateness())], STEP_S, clocks)
    twice: list[tuple[Partner, Lateness]] = [(Scripted("a", straight), Lateness())] * 2
    with pytest.raises(CosimulationError, match="Two partners are called 'a'"):
        Conductor(twice, STEP_S, clocks)

    other = Scripted("b", straight)
    other.start = Scripted("a", straight).start  # type: ignore[method-assign]
    with pytest.raises(CosimulationError, match="'a' and 'b' both have an actor 'a'"):
        _run([(Scripted("a", straight), Lateness()), (other, Lateness())], 1, clocks)

    early = Scripted("a", straight)
    early.advance = lambda request: request.others or early.start()  # type: ignore[method-assign]
    record = _run([(early, Lateness())], 5, clocks)
    assert record.lost == "'a' said where 'a' is at 0 s; it was asked for 0.02 s."
