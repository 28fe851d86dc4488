"""Simulated clocks of a client and a server, and the network between them.

The true times are known, and no clock of the machine is read.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.science.clock import ClockMapping, ClockProbes, fit_clock

FloatArray = npt.NDArray[np.float64]
TIMEOUT_S = 2.0
STEPS_AT = 0.53
SERVER_STARTS_S = 86_400.0
UTC_S = 1_772_443_800.0


@dataclass(frozen=True)
class Scenario:
    """The clocks and the network between a client and the server.

    `up_ms`, `down_ms`: shortest delays of the network in each direction. `queues_ms`: mean of the
    queueing delay that is added to each direction, Gamma with `queues_shape`: at 0.5 mostly short
    and sometimes long, at 2 rarely short. `warming_ppm`: change of the client's rate while it warms
    up over ten minutes. `wander_ppm`: random walk of that rate, per root second. Steps happen at 53
    % of the time; the server's wall clock does not step. `asleep_s`: how long the client and its
    clock are then suspended. `wrong`: number of impossible probes. `resolution_s`: the resolution
    in which the client's clock is read. `slew_ppm`: how much faster the server's clock runs in the
    second third.
    """

    name: str
    skew_s: float = 0.0
    drift_ppm: float = 0.0
    warming_ppm: float = 0.0
    wander_ppm: float = 0.0
    up_ms: float = 2.0
    down_ms: float = 2.0
    queues_ms: float = 0.0
    queues_shape: float = 0.5
    lost: float = 0.0
    client_step_s: float = 0.0
    asleep_s: float = 0.0
    server_step_s: float = 0.0
    wrong: int = 0
    resolution_s: float = 0.0
    slew_ppm: float = 0.0
    duration_s: float = 1750.0
    every_s: float = 1.0


_WIFI = Scenario(
    "wifi", skew_s=300.0, drift_ppm=100.0, warming_ppm=3.0, wander_ppm=0.01, queues_ms=3.0
)
_FAR = replace(_WIFI, name="far", up_ms=5.0, down_ms=40.0, queues_ms=8.0)
SYMMETRIC: tuple[Scenario, ...] = (
    replace(_WIFI, name="skew +5 min, 100 ppm"),
    replace(_WIFI, name="skew -5 min, -100 ppm", skew_s=-300.0, drift_ppm=-100.0),
    replace(_WIFI, name="busy network", queues_ms=30.0, queues_shape=2.0),
    replace(_WIFI, name="1 of 3 probes lost", lost=0.33),
    replace(_WIFI, name="20 impossible probes", wrong=20),
    replace(_WIFI, name="clock read in ms", resolution_s=0.001),
    replace(_WIFI, name="client steps +0.5 s", client_step_s=0.5),
    replace(_WIFI, name="client steps -0.5 s", client_step_s=-0.5),
    replace(_WIFI, name="client steps +30 s", client_step_s=30.0),
    replace(_WIFI, name="client steps -30 s", client_step_s=-30.0),
    replace(_WIFI, name="headset asleep for 60 s", asleep_s=60.0),
    replace(_WIFI, name="server steps +0.5 s", server_step_s=0.5),
    replace(_WIFI, name="server steps -0.5 s", server_step_s=-0.5),
    replace(_WIFI, name="server steps +30 s", server_step_s=30.0),
    replace(_WIFI, name="server steps -30 s", server_step_s=-30.0),
    replace(_WIFI, name="server restarts", server_step_s=-SERVER_STARTS_S),
    replace(_WIFI, name="a quarter of an hour", duration_s=900.0, wander_ppm=0.05),
    replace(_WIFI, name="three hours", duration_s=10_800.0),
    replace(_WIFI, name="one machine", up_ms=0.03, down_ms=0.03, queues_ms=0.1),
)
ASYMMETRIC: tuple[Scenario, ...] = (
    replace(_FAR, name="5 ms up, 40 ms down"),
    replace(_FAR, name="40 ms up, 5 ms down", up_ms=40.0, down_ms=5.0),
    replace(_FAR, name="0 ms up, 40 ms down", up_ms=0.0, queues_ms=1.0),
    replace(_FAR, name="asymmetric, lost, wrong", lost=0.33, wrong=20),
    replace(_FAR, name="asymmetric, client +0.5 s", client_step_s=0.5),
    replace(_FAR, name="asymmetric, client -30 s", client_step_s=-30.0),
    replace(_FAR, name="asymmetric, server +30 s", server_step_s=30.0),
    replace(_FAR, name="asymmetric, server -0.5 s", server_step_s=-0.5),
)


SLEWING = replace(_WIFI, name="server slews 350 ppm", slew_ppm=350.0)
"""A scenario beyond the drift limit: the offset bends twice, hidden in the round trips."""


@dataclass(frozen=True, eq=False)
class Simulated:
    """Probes, and events with the client's time and the server's true time, (k,) each."""

    probes: ClockProbes
    event_client_s: FloatArray
    event_server_s: FloatArray


@dataclass(frozen=True)
class Outcome:
    """Errors, bounds and coverage of a mapping on a scenario's events, in ms and as shares."""

    scenario: str
    residual_p50_ms: float
    residual_p95_ms: float
    bound_p50_ms: float
    bound_p95_ms: float
    coverage: float
    negative: int
    segments: int
    left_out: int


def simulate(scenario: Scenario, rng: np.random.Generator, *, events: int = 2000) -> Simulated:
    """Return the probes and events of the scenario."""
    duration_s = scenario.duration_s
    client = _ClientClock(scenario, rng)
    sent_s = np.arange(0.0, duration_s, scenario.every_s)
    sent_s += rng.uniform(0.0, 0.05, len(sent_s))
    arrived_s = sent_s + _way_s(scenario.up_ms, scenario, rng, len(sent_s))
    answered_s = arrived_s + rng.uniform(20e-6, 200e-6, len(sent_s))
    back_s = answered_s + _way_s(scenario.down_ms, scenario, rng, len(sent_s))
    stored_s = back_s + rng.uniform(0.002, 0.08, len(sent_s))
    probes = ClockProbes(
        client(sent_s),
        _server(scenario, arrived_s),
        _server(scenario, answered_s),
        client(back_s),
        UTC_S + stored_s,
    )
    _spoil(probes, scenario, rng)
    lost = (rng.random(len(sent_s)) < scenario.lost) | (back_s - sent_s > TIMEOUT_S)
    lost |= _asleep(scenario, sent_s) | _asleep(scenario, back_s)
    for readings in probes.arrays[1:4]:
        readings[lost] = np.nan
    event_s = np.sort(rng.uniform(0.0, duration_s, events))
    event_s = event_s[~_asleep(scenario, event_s)]
    return Simulated(probes, client(event_s), _server_without_steps(scenario, event_s))


def outcome(
    scenario: Scenario, rng: np.random.Generator, mapping: ClockMapping | None = None
) -> Outcome:
    """Fit the scenario's probes and compare the mapping of its events with the truth."""
    simulated = simulate(scenario, rng)
    mapping = mapping or fit_clock(simulated.probes)
    server_s, uncertainty_s = mapping.to_server(simulated.event_client_s)
    residual_s = np.abs(server_s - simulated.event_server_s)
    in_order = np.argsort(simulated.event_client_s, kind="stable")
    return Outcome(
        scenario=scenario.name,
        residual_p50_ms=1000.0 * float(np.percentile(residual_s, 50)),
        residual_p95_ms=1000.0 * float(np.percentile(residual_s, 95)),
        bound_p50_ms=1000.0 * float(np.percentile(uncertainty_s, 50)),
        bound_p95_ms=1000.0 * float(np.percentile(uncertainty_s, 95)),
        coverage=float(np.mean(residual_s <= uncertainty_s)),
        negative=int(np.sum(np.diff(server_s[in_order]) < 0.0)),
        segments=len(mapping.segments),
        left_out=sum(segment.left_out for segment in mapping.segments),
    )


def table(outcomes: list[Outcome]) -> str:
    """Return the outcomes as a table with one line per scenario."""
    head = (
        f"{'scenario':28} {'residual p50':>12} {'p95 ms':>8} {'bound p50':>10} {'p95 ms':>9}"
        f" {'covered':>8} {'negative':>8} {'segments':>8} {'left out':>8}"
    )
    lines = [head]
    lines += [
        f"{one.scenario:28} {one.residual_p50_ms:12.3f} {one.residual_p95_ms:8.3f}"
        f" {one.bound_p50_ms:10.2f} {one.bound_p95_ms:9.2f} {100 * one.coverage:7.2f}%"
        f" {one.negative:8d} {one.segments:8d} {one.left_out:8d}"
        for one in outcomes
    ]
    return "\n".join(lines)


class _ClientClock:
    """The client's clock, read at true times."""

    def __init__(self, scenario: Scenario, rng: np.random.Generator) -> None:
        self._scenario = scenario
        seconds = np.arange(0.0, scenario.duration_s + 10.0)
        rate = np.cumsum(rng.normal(0.0, 1e-6 * scenario.wander_ppm, len(seconds)))
        rate += 1e-6 * (scenario.drift_ppm + scenario.warming_ppm * (1 - np.exp(-seconds / 600.0)))
        self._seconds = seconds
        self._ahead_s = np.concatenate(([0.0], np.cumsum(rate[:-1])))

    def __call__(self, true_s: FloatArray) -> FloatArray:
        """Return (n,) readings at (n,) true times."""
        own = self._scenario
        client_s = 1000.0 + own.skew_s + true_s + np.interp(true_s, self._seconds, self._ahead_s)
        slept_s = np.clip(true_s - STEPS_AT * own.duration_s, 0.0, own.asleep_s)
        client_s = (
            client_s
            - slept_s
            + np.where(true_s >= STEPS_AT * own.duration_s, own.client_step_s, 0.0)
        )
        if own.resolution_s:
            client_s = np.floor(client_s / own.resolution_s) * own.resolution_s
        return client_s


def _asleep(scenario: Scenario, true_s: FloatArray) -> npt.NDArray[np.bool_]:
    since_s = true_s - STEPS_AT * scenario.duration_s
    return (since_s >= 0.0) & (since_s < scenario.asleep_s)


def _server(scenario: Scenario, true_s: FloatArray) -> FloatArray:
    step_s = np.where(true_s >= STEPS_AT * scenario.duration_s, scenario.server_step_s, 0.0)
    return _server_without_steps(scenario, true_s) + step_s


def _server_without_steps(scenario: Scenario, true_s: FloatArray) -> FloatArray:
    third_s = scenario.duration_s / 3
    slewing_s = np.clip(true_s - third_s, 0.0, third_s)
    server_s: FloatArray = SERVER_STARTS_S + true_s + 1e-6 * scenario.slew_ppm * slewing_s
    return server_s


def _way_s(
    shortest_ms: float, scenario: Scenario, rng: np.random.Generator, count: int
) -> FloatArray:
    shape = scenario.queues_shape
    queues_ms = rng.gamma(shape, scenario.queues_ms / shape, count)
    way: FloatArray = (shortest_ms + queues_ms) / 1000.0
    return way


def _spoil(probes: ClockProbes, scenario: Scenario, rng: np.random.Generator) -> None:
    """Make single probes impossible: half return before they were sent, half are seconds off."""
    wrong = rng.choice(np.arange(5, len(probes) - 5, 5), scenario.wrong, replace=False)
    half = scenario.wrong // 2
    probes.client_received_s[wrong[:half]] -= rng.uniform(0.5, 5.0, half)
    late = wrong[half:]
    shift_s = rng.choice([-1.0, 1.0], len(late)) * rng.uniform(0.5, 5.0, len(late))
    probes.server_received_s[late] += shift_s
    probes.server_sent_s[late] += shift_s
