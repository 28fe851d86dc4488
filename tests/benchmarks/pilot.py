"""Measure a pilot: how its people move, what latency does to them, power, speed, broken studies.

`movement`: reaches of 40 cm in the open beside the laws that people follow. `cohort`: 60 simulated
people in a hand task of 12 s at 0, 125 and 350 ms, each with all three, through the physics avatar;
its peers are the published performances at 45, 125 and 350 ms end to end, of another task. `speed`:
a whole visit beside MuJoCo's own steps of it. `power`: the published powers, and the time to the
first curve of the shipped study. `broken`: five studies with one fault each, which the check has to
name.

Everything is simulated, and says nothing about people.
"""

import re
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import mujoco
import numpy as np

from app.cli.pilot.check import carry_out_check
from app.cli.pilot.inputs import StudyFile, read_assumptions, read_study
from app.features.results.pilot.simulation import (
    PUBLISHED as PUBLISHED_PERFORMANCE,
)
from app.features.results.pilot.simulation import (
    Cohort,
    CohortOrder,
    CohortReport,
    PowerOrder,
    Sharing,
    check_study,
    failures_of,
    report_on,
    simulate_cohort,
    simulate_power,
)
from app.protocol import StudyProtocol
from app.simulated_people.visits import AvatarKind, simulate_visit
from tests.benchmarks.report import Figure, Report
from tests.protocol.helpers import CONFIGS
from tests.science.pilot.known_powers import PUBLISHED, SETS, simulated_power
from tests.science.simulation.reaches import fitts_slope_s_per_bit, reach_of

PARTS = ("movement", "cohort", "speed", "power", "broken")
PEOPLE, SEED, WORKERS = 60, 60, 2
REACHES: Final = 16
STUDY: Final = "reembodiment-latency"
HALF_OF_MINIMUM_JERK: Final = 0.541
"""Share of a minimum-jerk movement with more than half of its peak speed."""
FITTS_S_PER_BIT: Final = (0.10, 0.27)
"""10.1 bit/s in tapping (Fitts 1954); 3.7 to 4.9 for a mouse (Soukoreff and MacKenzie 2004)."""
SPEED_RUNS: Final = 3
LIMIT_S_PER_VISIT: Final = 12.0
"""120 visits in 12 minutes on two cores."""


def measure(parts: frozenset[str], runs: int | None = None) -> Report:
    """Measure the named parts; `runs`: people of the cohort, instead of 60."""
    report = Report("pilot")
    if "movement" in parts:
        report.add(*_movement())
    if "cohort" in parts:
        _add_cohort(report, runs or PEOPLE)
    if "speed" in parts:
        report.add(*_speed())
    if "power" in parts:
        _add_power(report)
    if "broken" in parts:
        report.add(*_broken())
    return report


def _movement() -> Iterator[Figure]:
    reaches = [reach_of(seed) for seed in range(REACHES)]
    half = float(np.median([one.half_share for one in reaches]))
    yield Figure(
        "movement", "deviation from straight, median",
        100 * float(np.median([one.deviation for one in reaches])), "%", "at most", 5.0,
    )  # fmt: skip
    yield Figure(
        "movement", "peak of the speed, within its upper half",
        float(np.median([one.peak_share for one in reaches])), "share", "in the middle", 0.5,
    )  # fmt: skip
    yield Figure(
        "movement", "time above half the peak speed", half, "share", "minimum jerk",
        HALF_OF_MINIMUM_JERK,
    )  # fmt: skip
    slope, (low, high) = fitts_slope_s_per_bit(), FITTS_S_PER_BIT
    yield Figure("movement", "Fitts slope, lower end of the range", slope, "s/bit", "at least", low)
    yield Figure("movement", "Fitts slope, upper end of the range", slope, "s/bit", "at most", high)


def _add_cohort(report: Report, people: int) -> None:
    study = _written(_hand_study())
    cohort = simulate_cohort(
        study, CohortOrder(people, SEED), lambda _: None, sharing=Sharing(WORKERS)
    )
    found = report_on(study, cohort, check_study(study, lambda _: None), None)
    report.add(*_cohort_figures(found, cohort))
    report.beside |= {
        "participants": people,
        "seed": SEED,
        "sha256": cohort.sha256,
        "real_time_factor": cohort.real_time_factor,
        "failures": failures_of(cohort),
        "reach": [asdict(one) for one in found.reached],
    }


def _cohort_figures(found: CohortReport, cohort: Cohort) -> Iterator[Figure]:
    for cell in found.cells:
        name = f"completions at {cell.latency_ms:g} ms"
        yield Figure("cohort", name, cell.completions, "tasks")
        yield Figure("cohort", f"{name}, SD", cell.completions_sd, "tasks")
        if cell.share_of_lowest is not None:
            published = PUBLISHED_PERFORMANCE.get(cell.latency_ms or 45.0)
            peer = "published, end to end" if published is not None else ""
            yield Figure(
                "cohort", f"{name}, of those at 0 ms", 100 * cell.share_of_lowest, "%", peer,
                published,
            )  # fmt: skip
    for change in found.changes:
        if change.measure not in ("completions", "contact_time_s"):
            continue
        unit = "tasks" if change.measure == "completions" else "s"
        words = change.measure.replace("_", " ").removesuffix(" s")
        yield Figure("cohort", f"change of {words}, 0 to 350 ms", change.mean, unit)
        yield Figure("cohort", f"change of {words}, lower bound", change.low, unit)
        yield Figure("cohort", f"change of {words}, upper bound", change.high, unit)
        nearest = min(change.low, change.high, key=abs)
        excludes_0 = change.low * change.high > 0.0
        yield Figure(
            "cohort", f"change of {words}, distance of its interval from 0",
            abs(nearest) if excludes_0 else 0.0, unit, "at least", 1e-9,
        )  # fmt: skip
    yield Figure("cohort", "visits not completed", failures_of(cohort), "visits", "at most", 0.0)
    factor = cohort.real_time_factor or 0.0
    yield Figure("cohort", "real-time factor", factor, "s of visits per s of processor")


def _speed() -> Iterator[Figure]:
    """Time visits of the shipped study in phases of 8 s, and MuJoCo's share of them."""
    text = (CONFIGS / f"{STUDY}.yaml").read_text(encoding="utf-8")
    whole = _written(text).study.protocol
    study = _written(re.sub(r"duration_s: 60", "duration_s: 8", text)).study.protocol
    phases = [step.duration_s or 0.0 for step in whole.procedure.block.phases]
    active_s = len(whole.conditions) * sum(phases)
    # Compiles what numba compiles.
    simulate_visit(study, 1, SEED, "physics")
    factor, share = _speed_of(study, "physics")
    name, visit = "real-time factor", f"processor time of a visit of 6 phases of {phases[0]:g} s"
    yield Figure("speed", f"{name}, with fingers", factor, "s of visit per s of processor")
    yield Figure("speed", "MuJoCo's own steps of it, with fingers", share, "share", "at least", 0.7)
    yield Figure("speed", f"{visit}, with fingers", active_s / factor, "s")
    factor, share = _speed_of(study, "physics_without_fingers")
    yield Figure("speed", f"{name}, without fingers", factor, "s of visit per s of processor")
    yield Figure("speed", "MuJoCo's own steps of it, without fingers", share, "share")
    yield Figure(
        "speed", f"{visit}, without fingers", active_s / factor, "s", "at most", LIMIT_S_PER_VISIT
    )


def _speed_of(study: StudyProtocol, kind: AvatarKind) -> tuple[float, float]:
    """Return a visit's seconds per second of processor time, and the share of it in `mj_step`.

    Medians; the share is that of a visit of its own, since timing each step slows a visit down.
    """
    own = mujoco.mj_step
    spent_s = 0.0

    def timed(*arguments: Any) -> None:
        nonlocal spent_s
        began_s = time.process_time()
        own(*arguments)
        spent_s += time.process_time() - began_s

    factors, shares = [], []
    for _ in range(SPEED_RUNS):
        began_s = time.process_time()
        visit = simulate_visit(study, 0, SEED, kind)
        factors.append(visit.simulated_s / (time.process_time() - began_s))
        mujoco.mj_step, spent_s = timed, 0.0
        try:
            began_s = time.process_time()
            simulate_visit(study, 0, SEED, kind)
            shares.append(spent_s / (time.process_time() - began_s))
        finally:
            mujoco.mj_step = own
    return float(np.median(factors)), float(np.median(shares))


def _add_power(report: Report) -> None:
    for n, eta, published in PUBLISHED:
        point = simulated_power(n, eta, seed=24)
        error = float(np.sqrt(published * (1.0 - published) / SETS))
        name = f"power of the rm ANOVA, n = {n}"
        report.add(
            Figure("power", name, point.power, "share", "G*Power 3", published),
            Figure(
                "power", f"{name}, distance", abs(point.power - published) / error,
                "standard errors", "at most", 2.0,
            ),
        )  # fmt: skip
    study = read_study(STUDY)
    began_s = time.perf_counter()
    curve = simulate_power(study, read_assumptions(None, study), PowerOrder(), lambda _: None)
    took_s = time.perf_counter() - began_s
    widest = max(max(one.high - one.power, one.power - one.low) for one in curve.points)
    report.add(
        Figure("power", "first curve", took_s, "s", "at most", 60.0),
        Figure("power", "widest band", 100 * widest, "points", "at most", 8.0),
    )
    keys = ("n", "power", "low", "high", "level")
    report.beside["power"] = [{key: getattr(one, key) for key in keys} for one in curve.points]


def _broken() -> Iterator[Figure]:
    found = 0
    for kind, change in _FAULTS.items():
        text = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")
        broken = change(text)
        if broken == text:
            raise ValueError(f"the fault {kind} changes nothing")
        checked = check_study(_written(broken), lambda _: None)
        found += [one.kind for one in checked.findings] == [kind]
    with tempfile.TemporaryDirectory() as folder:
        room = Path(folder) / "room.yaml"
        room.write_text(_ROOM, encoding="utf-8")
        checked = carry_out_check("two-latencies-hand", str(room), lambda _: None)
        found += [one.kind for one in checked.findings] == ["scene_without_path"]
    number = len(_FAULTS) + 1
    yield Figure("broken", "faults found and named", found, "studies", "at least", number)


_FAULTS: Final[dict[str, Callable[[str], str]]] = {
    "out_of_reach": lambda text: text.replace(
        "center_m: [-0.33, 1.2, -0.55]", "center_m: [-0.33, 1.2, -2.00]"
    ),
    "phase_too_short": lambda text: text.replace(
        "duration_s: 60\n        freeze", "duration_s: 7\n        freeze"
    ),
    "latency_over_buffer": lambda text: text.replace("latency_ms: 200", "latency_ms: 2500"),
    "unbalanced_orders": lambda text: text.replace(
        "design: all_permutations",
        "design: explicit\n  sequences:\n    - [latency_0, latency_200]",
    ),
}
"""Faults of a study alone, by what the check calls them."""
_ROOM: Final = """
key: divided-room
bounds_m: [0, 0, 4, 4]
places: {door: [0.5, 2.0], boxes: [3.5, 2.0]}
paths: [{name: to the boxes, from: door, to: boxes}]
obstacles:
  - {name: wall, shape: wall, from_m: [2.0, 0.0], to_m: [2.0, 4.0], thickness_m: 0.1}
"""


def _hand_study() -> str:
    text = (CONFIGS / "templates" / "two-latencies-hand.yaml").read_text(encoding="utf-8")
    text = text.replace("duration_s: 60\n        freeze", "duration_s: 12\n        freeze")
    middle = "    label: {en: 125 ms added, de: 125 ms zusätzlich}\n"
    longest = "  - key: latency_350\n    latency_ms: 350\n"
    text = text.replace(
        "  - key: latency_200\n    latency_ms: 200\n",
        f"  - key: latency_125\n    latency_ms: 125\n{middle}{longest}",
    )
    return text.replace("200 ms added, de: 200 ms", "350 ms added, de: 350 ms")


def _written(text: str) -> StudyFile:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "study.yaml"
        file.write_text(text, encoding="utf-8")
        return read_study(str(file))
