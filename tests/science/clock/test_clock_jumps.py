"""Tests of breaks in the clocks: single wrong probes, jumps of either clock, and gaps."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.clock import ClockProbes, fit_clock
from tests.science.clock.simulated import STEPS_AT, SYMMETRIC, UTC_S, simulate

PLAIN = replace(SYMMETRIC[0], duration_s=600.0)
STEP_AT_S = STEPS_AT * PLAIN.duration_s


def _wrong(place: int, count: int) -> ClockProbes:
    """Return probes of ten minutes of which `count` were answered by a server 3 s ahead."""
    probes = simulate(PLAIN, np.random.default_rng(1)).probes
    for readings in (probes.server_received_s, probes.server_sent_s):
        readings[place : place + count] += 3.0
    return probes


@pytest.mark.parametrize("place", [0, 1, 150, 299, 300, 301, 302, 598, 599])
def test_one_impossible_probe_is_left_out_and_cuts_nothing(place: int) -> None:
    """One wrong probe is left out and starts no new segment, wherever it is."""
    probes = _wrong(place, 1)
    mapping = fit_clock(probes)
    assert sum(segment.left_out for segment in mapping.segments) == 1
    assert [segment.stepped for segment in mapping.segments] == ["", ""]
    others = np.arange(len(probes)) != place
    times_s = probes.client_sent_s
    expected, _ = fit_clock(probes.select(others)).to_server(times_s)
    assert mapping.to_server(times_s)[0] == pytest.approx(expected, abs=1e-4)


def test_a_negative_round_trip_is_left_out() -> None:
    """A probe with a negative round trip is counted as left out and has no influence."""
    probes = simulate(PLAIN, np.random.default_rng(2)).probes
    expected, _ = fit_clock(probes.select(np.arange(len(probes)) != 77)).to_server(
        probes.client_sent_s
    )
    probes.client_received_s[77] -= 0.5
    mapping = fit_clock(probes)
    assert mapping.to_server(probes.client_sent_s)[0] == pytest.approx(expected, abs=1e-9)
    assert [segment.left_out for segment in mapping.segments] == [1, 0]


def test_two_probes_that_agree_are_a_jump() -> None:
    """Two consecutive probes that agree on another offset are a jump, and so is the way back."""
    mapping = fit_clock(_wrong(200, 2))
    assert [round(segment.step_s) for segment in mapping.segments if segment.stepped] == [3, -3]


@pytest.mark.parametrize(
    ("client_step_s", "server_step_s", "whose"),
    [(0.5, 0.0, "client"), (-30.0, 0.0, "client"), (0.0, 0.5, "server"), (0.0, -30.0, "server")],
)
def test_a_jump_is_reported_with_its_size_and_its_clock(
    client_step_s: float, server_step_s: float, whose: str
) -> None:
    """A jump is reported with its size and the clock that jumped, by majority of three clocks."""
    stepping = replace(PLAIN, client_step_s=client_step_s, server_step_s=server_step_s)
    mapping = fit_clock(simulate(stepping, np.random.default_rng(3)).probes)
    (stepped,) = [segment for segment in mapping.segments if segment.stepped]
    assert stepped.stepped == whose
    assert stepped.step_s == pytest.approx(server_step_s - client_step_s, abs=0.005)


def test_without_a_wall_clock_only_a_server_that_goes_back_is_caught() -> None:
    """Without a wall clock, a server's jump ahead looks the same as a suspended client."""
    for server_step_s, whose in ((30.0, "client"), (-30.0, "server")):
        stepping = replace(PLAIN, server_step_s=server_step_s)
        probes = simulate(stepping, np.random.default_rng(4)).probes
        mapping = fit_clock(ClockProbes(*probes.arrays[:4]))
        assert [segment.stepped for segment in mapping.segments if segment.stepped] == [whose]


def test_a_wall_clock_that_is_set_bends_nothing() -> None:
    """A change of the wall clock affects only `wall_s` of the segments, not the mapping."""
    probes = simulate(PLAIN, np.random.default_rng(5)).probes
    plain = fit_clock(probes)
    assert probes.server_utc_s is not None
    set_back = np.where(probes.server_utc_s > UTC_S + STEP_AT_S, -30.0, 0.0)
    stepped = fit_clock(replace(probes, server_utc_s=probes.server_utc_s + set_back))
    times_s = probes.client_sent_s
    for one, other in zip(plain.to_server(times_s), stepped.to_server(times_s), strict=True):
        assert np.array_equal(one, other)
    first, last = stepped.segments[0].wall_s, stepped.segments[-1].wall_s
    assert last - first == pytest.approx(-30.0, abs=0.1)


def test_around_a_jump_the_bound_covers_both_sides() -> None:
    """Between the last probe before a jump and the first after, the bound covers both offsets."""
    stepping = replace(PLAIN, client_step_s=0.5)
    simulated = simulate(stepping, np.random.default_rng(6), events=200_000)
    server_s, uncertainty_s = fit_clock(simulated.probes).to_server(simulated.event_client_s)
    assert (np.abs(server_s - simulated.event_server_s) <= uncertainty_s).all()
    assert 0.4 < uncertainty_s.max() < 1.0


def _halves(
    way_s: tuple[float, float], trip_s: tuple[float, float], step_s: float, every_s: float = 1.0
) -> ClockProbes:
    """Return two hundred probes whose uplink delay and round trip differ between the halves.

    True server and client times are equal. The server's clock steps between the halves; its wall
    clock does not.
    """
    sent_s = every_s * np.arange(200, dtype=np.float64) + 0.0123
    second = np.arange(200) >= 100
    received_s = sent_s + np.where(second, way_s[1], way_s[0])
    server_s = received_s + np.where(second, step_s, 0.0)
    back_s = sent_s + np.where(second, trip_s[1], trip_s[0])
    return ClockProbes(sent_s, server_s, server_s.copy(), back_s, UTC_S + received_s)


@pytest.mark.parametrize("way_s", [(0.0, 0.001), (0.04, 0.001)])
def test_undoing_a_jump_of_the_server_keeps_its_uncertainty(way_s: tuple[float, float]) -> None:
    """After an undone jump the bound keeps the jump's uncertainty, however fast the network."""
    probes = _halves(way_s, (0.04, 0.002), 5.0)
    mapping = fit_clock(probes)
    assert [segment.stepped for segment in mapping.segments] == ["", "server"]
    server_s, uncertainty_s = mapping.to_server(probes.client_sent_s)
    assert (np.abs(server_s - probes.client_sent_s) <= uncertainty_s).all()


def test_the_course_never_falls_even_where_the_probes_look_like_it() -> None:
    """Mapped time never goes back, even if replies become slow as the client steps 5 ms ahead."""
    probes = _halves((0.04, 0.0), (0.04, 0.04), 0.0, every_s=0.041)
    ahead_s = np.where(np.arange(200) >= 100, 0.005, 0.0)
    client_s = probes.client_sent_s + ahead_s
    mapping = fit_clock(replace(probes, client_sent_s=client_s, client_received_s=client_s + 0.04))
    assert [segment.stepped for segment in mapping.segments] == ["", "client"]
    first, last = mapping.segments
    assert last.client_from_s + last.offset_s < first.client_to_s + first.offset_s
    server_s, uncertainty_s = mapping.to_server(client_s)
    assert (np.abs(server_s - probes.client_sent_s) <= uncertainty_s).all()
    course_s, _ = mapping.to_server(np.linspace(-1.0, 10.0, 20_001))
    assert (np.diff(course_s) >= 0.0).all()


def test_a_repeated_client_time_is_mapped_to_its_first_occurrence() -> None:
    """A client time that occurs twice maps to the first, and the bound covers the second."""
    stepping = replace(PLAIN, client_step_s=-30.0)
    simulated = simulate(stepping, np.random.default_rng(7), events=20_000)
    server_s, uncertainty_s = fit_clock(simulated.probes).to_server(simulated.event_client_s)
    error_s = np.abs(server_s - simulated.event_server_s)
    assert (error_s <= uncertainty_s).all()
    assert np.mean(error_s > 0.005) == pytest.approx(30.0 / 600.0, abs=0.005)
    assert np.mean(uncertainty_s > 29.0) == pytest.approx(60.0 / 600.0, abs=0.005)


def test_a_gap_is_bridged_with_a_bound_that_grows_towards_its_middle() -> None:
    """Over ten minutes without replies the bound grows with the drift limit towards the middle."""
    quiet = replace(PLAIN, duration_s=1200.0)
    probes = simulate(quiet, np.random.default_rng(8)).probes
    heard = (np.arange(len(probes)) < 300) | (np.arange(len(probes)) >= 900)
    mapping = fit_clock(probes.select(heard))
    begin_s, end_s = probes.client_sent_s[300], probes.client_sent_s[899]
    times_s = np.linspace(begin_s, end_s, 7)
    server_s, uncertainty_s = mapping.to_server(times_s)
    assert uncertainty_s[2:5].min() > 0.1
    assert uncertainty_s[[0, -1]].max() < 0.005
    assert uncertainty_s.max() < 1.1 * 300 * 600e-6
    assert not any(segment.stepped for segment in mapping.segments)
    expected, _ = fit_clock(probes).to_server(times_s)
    assert server_s == pytest.approx(expected, abs=0.001)
