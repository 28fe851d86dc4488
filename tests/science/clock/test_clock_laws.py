"""Tests of properties of every clock mapping, and cases with a known solution."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.clock import ClockError, ClockLimits, ClockProbes, fit_clock
from tests.science.clock.simulated import SLEWING, SYMMETRIC, Scenario, simulate

PLAIN = SYMMETRIC[0]


def _probes(
    offset_s: float, way_s: float = 0.0, count: int = 50, drift: float = 0.0
) -> ClockProbes:
    """Return probes that a client sends once a second and a server answers immediately."""
    sent_s = 10.0 + 1.0007 * np.arange(count, dtype=np.float64) + 0.12345
    received_s = sent_s + 2 * way_s
    server_s = (sent_s + way_s) * (1.0 + drift) + offset_s
    return ClockProbes(sent_s, server_s, server_s, received_s)


def _moved(probes: ClockProbes, client_s: float, server_s: float) -> ClockProbes:
    return ClockProbes(
        probes.client_sent_s + client_s,
        probes.server_received_s + server_s,
        probes.server_sent_s + server_s,
        probes.client_received_s + client_s,
    )


@pytest.mark.parametrize(("client_s", "server_s"), [(512.0, 0.0), (0.0, -77.25), (-3.5, 1e5)])
def test_shifting_a_clock_shifts_the_offset(client_s: float, server_s: float) -> None:
    """A shift of either clock shifts the mapping by the same amount and changes nothing else."""
    simulated = simulate(PLAIN, np.random.default_rng(1))
    times_s = simulated.event_client_s
    plain, doubt_s = fit_clock(_moved(simulated.probes, 0.0, 0.0)).to_server(times_s)
    moved, moved_doubt_s = fit_clock(_moved(simulated.probes, client_s, server_s)).to_server(
        times_s + client_s
    )
    assert moved - server_s == pytest.approx(plain, abs=1e-8)
    assert moved_doubt_s == pytest.approx(doubt_s, abs=1e-8)


@pytest.mark.parametrize("drift", [0.0, 100e-6, -250e-6])
def test_without_delay_the_mapping_is_exact(drift: float) -> None:
    """Without network delay the mapping is exact to a microsecond and the bound is the slack."""
    mapping = fit_clock(_probes(-3.75, drift=drift))
    times_s = np.linspace(12.0, 58.0, 40)
    server_s, uncertainty_s = mapping.to_server(times_s)
    assert server_s == pytest.approx(times_s * (1.0 + drift) - 3.75, abs=1e-6)
    assert uncertainty_s.max() < 4 * ClockLimits().slack_s
    assert mapping.segments[0].drift == pytest.approx(drift, abs=1e-7)


def test_more_probes_never_widen_the_bound() -> None:
    """Additional probes never widen the bound."""
    probes = simulate(replace(PLAIN, duration_s=250.0), np.random.default_rng(2)).probes
    at_s = np.array([probes.client_sent_s[0] + 5.0])
    widths = []
    for count in (1, 2, 5, 20, 100, 240):
        (low,), (high,) = fit_clock(probes.select(np.arange(count))).placed[0].bounds_at(at_s)
        widths.append(high - low)
    assert widths == sorted(widths, reverse=True)
    assert widths[-1] < 0.6 * widths[0]


def test_one_probe_gives_half_its_round_trip() -> None:
    """The bound of one probe is half its round trip, growing with the drift limit around it."""
    limits = ClockLimits()
    server_s, uncertainty_s = fit_clock(_probes(7.0, way_s=0.02, count=1)).to_server(
        np.array([10.14345, 110.14345, -89.85655])
    )
    assert server_s == pytest.approx([17.14345, 117.14345, -82.85655])
    assert uncertainty_s[0] == pytest.approx(0.02 + 2 * limits.slack_s, abs=2e-5)
    assert uncertainty_s[1:] == pytest.approx(0.02 + 100 * limits.drift, abs=3e-4)


def test_without_a_probe_nothing_is_known() -> None:
    """Without probes, or for invalid times, the mapping gives NaN with an infinite bound."""
    none = fit_clock(_probes(0.0, count=0))
    lost = _probes(0.0, count=5)
    lost.client_received_s[:] = np.nan
    for mapping in (none, fit_clock(lost)):
        server_s, uncertainty_s = mapping.to_server(np.array([1.0, 2.0]))
        assert np.isnan(server_s).all()
        assert np.isinf(uncertainty_s).all()
        assert mapping.segments == ()
    server_s, uncertainty_s = fit_clock(_probes(0.0)).to_server(np.array([np.nan, np.inf, 20.0]))
    assert np.isnan(server_s).tolist() == [True, True, False]
    assert np.isinf(uncertainty_s).tolist() == [True, True, False]


def test_impossible_probes_alone_give_no_mapping() -> None:
    """Probes with impossible times alone give no mapping."""
    backwards = _probes(5.0, way_s=-0.25, count=4)
    assert fit_clock(backwards).segments == ()
    away = _probes(5.0, way_s=0.1, count=4)
    handled = replace(away, server_sent_s=away.server_sent_s + 0.5)
    assert fit_clock(handled).segments == ()


def test_a_wander_within_the_slack_cuts_nothing() -> None:
    """Offsets that wander by 80 us around a line give one segment whose bound covers them."""
    probes = _probes(1.0, count=200)
    server_s = probes.server_received_s + 80e-6 * np.sin(probes.client_sent_s / 12.0)
    probes = replace(probes, server_received_s=server_s, server_sent_s=server_s)
    mapping = fit_clock(probes)
    assert [segment.left_out for segment in mapping.segments] == [0]
    server_s, uncertainty_s = mapping.to_server(probes.client_sent_s)
    assert (np.abs(server_s - probes.server_received_s) <= uncertainty_s).all()


@pytest.mark.parametrize("seed", range(6))
def test_the_mapped_time_lies_between_the_bounds(seed: int) -> None:
    """The mapped time lies between the bounds, even where the probes' mean offset does not."""
    rng = np.random.default_rng(seed)
    sent_s = np.cumsum(rng.uniform(0.5, 1.5, 12))
    up_s = 0.05 * rng.beta(0.2, 0.6, 12)
    probes = ClockProbes(sent_s, sent_s + up_s, sent_s + up_s, sent_s + 0.05)
    mapping = fit_clock(probes)
    server_s, _ = mapping.to_server(sent_s)
    low, high = mapping.placed[0].bounds_at(sent_s)
    assert (server_s - sent_s >= low).all()
    assert (server_s - sent_s <= high).all()


def test_away_from_the_probes_the_bound_grows_with_the_drift_limit() -> None:
    """Before the first and after the last probe the bound grows by 500 ppm and the drift."""
    mapping = fit_clock(_probes(2.0, way_s=0.001, drift=100e-6))
    _, (near, far, early) = mapping.to_server(np.array([60.0, 1060.0, -940.0]))
    assert far - near == pytest.approx(1000 * (500e-6 + 100e-6), rel=0.02)
    assert early - near == pytest.approx(950 * (500e-6 + 100e-6), rel=0.02)


def test_segments_describe_the_mapping() -> None:
    """t + offset + drift (t - from) of its segment equals `to_server`, within its bound."""
    simulated = simulate(PLAIN, np.random.default_rng(5))
    mapping = fit_clock(simulated.probes)
    server_s, uncertainty_s = mapping.to_server(simulated.event_client_s)
    seen = np.zeros(len(server_s), dtype=int)
    for segment in mapping.segments:
        t_s = simulated.event_client_s
        mine = (t_s >= segment.client_from_s) & (t_s < segment.client_to_s)
        mapped_s = t_s + segment.offset_s + segment.drift * (t_s - segment.client_from_s)
        assert mapped_s[mine] == pytest.approx(server_s[mine], abs=1e-9)
        assert (uncertainty_s[mine] <= segment.uncertainty_s + 1e-9).all()
        seen += mine
    assert (seen[10:-10] == 1).all()
    assert sum(segment.probes for segment in mapping.segments) == len(simulated.probes)


def test_a_coarse_clock_widens_the_bound_by_its_step() -> None:
    """A clock read in hundredths of a second is detected, and widens the bound by its step."""
    coarse = Scenario("coarse", up_ms=1.0, down_ms=1.0, resolution_s=0.01, duration_s=200.0)
    mapping = fit_clock(simulate(coarse, np.random.default_rng(6)).probes)
    assert mapping.resolution_s == 0.01
    assert len(mapping.segments) == 1
    assert mapping.segments[0].left_out == 0
    assert fit_clock(simulate(PLAIN, np.random.default_rng(6)).probes).resolution_s == 0.0


def test_a_bend_beyond_the_limits_costs_at_most_a_round_trip() -> None:
    """A drift beyond the limits, which no bound covers, causes errors below 1.5 round trips."""
    simulated = simulate(SLEWING, np.random.default_rng(7))
    server_s, _ = fit_clock(simulated.probes).to_server(simulated.event_client_s)
    shortest_s = np.nanmin(simulated.probes.round_trip_s)
    assert np.abs(server_s - simulated.event_server_s).max() < 1.5 * shortest_s


def test_readings_of_different_shapes_are_rejected() -> None:
    """Readings of different shapes and invalid limits raise an error that states them."""
    with pytest.raises(ClockError, match="all must be"):
        ClockProbes(np.zeros(2), np.zeros(3), np.zeros(2), np.zeros(2))
    with pytest.raises(ClockError, match=r"drift is 0\.0"):
        ClockLimits(drift=0.0)
