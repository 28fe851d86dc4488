"""Measure how well our method and the usual one recover known latencies from flawed data."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.science.latency import StreamPair, latency_of_runs
from app.science.rotations import FloatArray
from app.science.skeleton import continuous
from tests.benchmarks.report import Figure, Report
from tests.science.moving_bodies import (
    Flaws,
    delayed_copy,
    looped_capture,
    made_movement,
    record,
)
from tests.support.shared_data import shared_data_folder

LATENCIES_S = (0.0, 0.0073, 0.125, 0.35)
SEEDS, DURATION_S, PHASE_S = 20, 20.0, 60.0
RATE_HZ, LONGEST_S, SMOOTHING_S, NOMINAL = 90.0, 1.5, 0.05, 95.0
SCENARIOS = {
    "noise 0.1 deg": Flaws(0.1),
    "noise 0.5 deg": Flaws(0.5),
    "noise 1.5 deg": Flaws(1.5),
    "20 % dropped": Flaws(0.5, jitter_s=0.002, dropped=0.2),
    "stamps off 2 ms": Flaws(0.5, jitter_s=0.002, stamp_s=0.002, dropped=0.2),
}
PARTS = (*SCENARIOS, "captures", "cost")
CAPTURES = ("02_01", "05_06", "06_01", "12_02")
Make = Callable[[float, int], StreamPair]


@dataclass(frozen=True)
class Trial:
    """One recording: its true latency, our estimate (s), and the usual method's estimate."""

    latency_s: float
    found_s: float
    low_s: float
    high_s: float
    rival_s: float

    @property
    def covered(self) -> bool:
        """Return whether the true latency is within the interval."""
        return self.low_s <= self.latency_s <= self.high_s


def measure(parts: frozenset[str]) -> Report:
    """Measure the named parts."""
    report = Report("latency")
    for name, flaws in SCENARIOS.items():
        if name in parts:
            report.add(*_figures(name, _trials(_made(flaws), SEEDS)))
    captures = _captures()
    if "captures" in parts and captures is not None:
        report.add(*_figures("captures", _trials(captures, len(CAPTURES))))
    if "cost" in parts:
        report.add(*_cost())
    return report


def _made(flaws: Flaws) -> Make:
    def make(latency_s: float, seed: int) -> StreamPair:
        rng = np.random.default_rng((seed, round(1e6 * latency_s)))
        return record(made_movement(rng), latency_s, rng, flaws, duration_s=DURATION_S)

    return make


def _captures() -> Make | None:
    """Return a function that delays motion captures as the avatar does; None without the data."""
    folder = shared_data_folder() / "motion" / "cmu_bvh"
    if not folder.is_dir():
        return None
    loops = [looped_capture(folder / f"{name}.bvh", DURATION_S) for name in CAPTURES]
    return lambda latency_s, number: delayed_copy(*loops[number], latency_s)


def _trials(make: Make, seeds: int) -> list[Trial]:
    return [_trial(make(each, seed), each) for each in LATENCIES_S for seed in range(seeds)]


def _trial(run: StreamPair, latency_s: float) -> Trial:
    found = latency_of_runs([run])
    if found.latency_s is None or found.low_s is None or found.high_s is None:
        raise RuntimeError(f"no latency for {latency_s} s: {found.reason}")
    return Trial(latency_s, found.latency_s, found.low_s, found.high_s, rival(run))


def rival(run: StreamPair) -> float:
    """Return the latency (s) by the usual method, velocity correlation with a parabolic peak."""
    begin_s, end_s = float(run.actual_times_s.min()), float(run.actual_times_s.max())
    grid_s = np.arange(begin_s, end_s, 1.0 / RATE_HZ)
    target = _velocities(run.target_times_s, run.target_rotations, grid_s)
    actual = _velocities(run.actual_times_s, run.actual_rotations, grid_s)
    spectra = [np.fft.rfft(one, 2 * len(grid_s), axis=0) for one in (target, actual)]
    correlation = np.fft.irfft(np.sum(np.conj(spectra[0]) * spectra[1], axis=1))
    lags = np.arange(-9, round(LONGEST_S * RATE_HZ))
    values = correlation[lags]
    at = int(np.clip(np.argmax(values), 1, len(values) - 2))
    before, peak, after = values[at - 1 : at + 2]
    shift = 0.5 * (before - after) / (before - 2.0 * peak + after)
    return float((lags[at] + shift) / RATE_HZ)


def _velocities(times_s: FloatArray, rotations: FloatArray, grid_s: FloatArray) -> FloatArray:
    """Return rates (k, 84) of the joints' quaternions at regular times, low-passed like ours."""
    order = np.argsort(times_s)
    q = continuous(rotations[order, 1:]).reshape(len(order), -1)
    regular = np.stack([np.interp(grid_s, times_s[order], column) for column in q.T], axis=1)
    rates: FloatArray = gaussian_filter1d(regular, SMOOTHING_S * RATE_HZ, axis=0, order=1)
    return rates


def _figures(part: str, trials: list[Trial]) -> list[Figure]:
    rows = []
    for latency_s in LATENCIES_S:
        own = [trial.found_s for trial in trials if trial.latency_s == latency_s]
        bias_ms = 1000.0 * (float(np.mean(own)) - latency_s)
        name = f"{1000.0 * latency_s:g} ms ordered: estimates are off by, mean"
        rows.append(Figure(part, name, bias_ms, "ms"))
    errors = [abs(trial.found_s - trial.latency_s) for trial in trials]
    rivals = [abs(trial.rival_s - trial.latency_s) for trial in trials]
    halves = [(trial.high_s - trial.low_s) / 2.0 for trial in trials]
    covered = 100.0 * float(np.mean([trial.covered for trial in trials]))
    peer = "parabola through the correlation"
    return [
        *rows,
        Figure(part, "largest error", 1000 * max(errors), "ms", peer, 1000 * max(rivals)),
        Figure(part, "half of the 95 % interval, mean", 1000 * float(np.mean(halves)), "ms"),
        Figure(part, f"intervals that cover, of {len(trials)}", covered, "%", "nominal", NOMINAL),
    ]


def _cost() -> list[Figure]:
    """Measure the processor time for a phase of a minute, without the first call's imports."""
    rng = np.random.default_rng(0)
    run = record(made_movement(rng), 0.125, rng, Flaws(0.5), duration_s=PHASE_S)
    latency_of_runs([run])
    times_s = []
    for _ in range(7):
        began_s = time.process_time()
        latency_of_runs([run])
        times_s.append(time.process_time() - began_s)
    words = "CPU for a phase of 60 s"
    return [
        Figure("cost", f"{words}, median", 1000 * float(np.median(times_s)), "ms", "limit", 1000.0),
        Figure("cost", f"{words}, largest", 1000 * max(times_s), "ms", "limit", 1000.0),
    ]
