"""Measure the headset's calibration on scripted people who differ as real ones do.

Stature, height of the eyes and span are those of British adults in Pheasant's table (1996,
Bodyspace, table 10.1; men and women, 5th, 50th and 95th percentile of the stature). The span at a
stature follows from the table's means and standard deviations and a correlation of 0.8, which is
assumed, at the 5th, 50th and 95th percentile of what is left. Everybody wears the devices
differently (straps by 2 cm and 15 degrees, grips by 5 mm and 5 degrees, standard deviations), sways
and breathes, and the devices are noisy (2 mm and 0.3 degrees in every frame).

The people are scripted: how real people hold a T-pose is not in it.
"""

import json
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from math import sqrt
from pathlib import Path
from statistics import quantiles
from typing import Any

from tests.benchmarks.report import Figure
from tests.support.node import install_packages, run_node

FRONTEND = Path(__file__).resolve().parents[2] / "frontend"
PART = "calibration"
STATURE_LIMIT_CM, SPAN_LIMIT_CM, RESIDUAL_LIMIT_CM = 1.0, 2.0, 3.0
WEARS = ("controllers", "hands", "shins", "body")
SEEDS = (1, 2)
CORRELATION = 0.8
AT_PERCENTILE = {5: -1.645, 50: 0.0, 95: 1.645}
USUAL_EYES = 0.936
NOISE_M, NOISE_RAD = 0.002, 0.005
BENT = 0.15
"""Share of a squat: the eyes are about 4 cm lower."""
CM_PER_M = 100.0
Json = dict[str, Any]


@dataclass(frozen=True)
class Population:
    """A row of the table, in metres: by percentile, and standard deviations."""

    stature: dict[int, float]
    eyes: dict[int, float]
    stature_sd: float
    span_mean: float
    span_sd: float

    def span(self, percentile: int, proportion: int) -> float:
        """Return the span at a percentile of the stature and one of what it leaves open."""
        from_mean = self.stature[percentile] - self.stature[50]
        expected = self.span_mean + CORRELATION * self.span_sd / self.stature_sd * from_mean
        left = self.span_sd * sqrt(1.0 - CORRELATION**2)
        return expected + AT_PERCENTILE[proportion] * left


POPULATIONS = {
    "men": Population(
        {5: 1.625, 50: 1.740, 95: 1.855}, {5: 1.515, 50: 1.630, 95: 1.745}, 0.070, 1.790, 0.083
    ),
    "women": Population(
        {5: 1.505, 50: 1.610, 95: 1.710}, {5: 1.405, 50: 1.505, 95: 1.610}, 0.062, 1.605, 0.071
    ),
}


def calibrations() -> list[Figure]:
    """Calibrate everybody, and return what was found."""
    people = [*_usual(), *_with_tabled_eyes(), *_swapped(), *_bent()]
    found = _calibrated([wish for _, wish in people])
    groups: dict[str, list[tuple[Json, Json]]] = {}
    for (label, wish), one in zip(people, found, strict=True):
        groups.setdefault(label, []).append((wish, one))
    figures: list[Figure] = []
    for wears in WEARS:
        figures += _accuracy(wears, groups[wears])
    off_cm = _off_cm(groups["tabled eyes"], "statureM")
    name = "eyes at the height of the table"
    figures += [
        Figure(PART, f"{name}: people", len(off_cm), ""),
        Figure(PART, f"{name}: stature off by, worst", max(off_cm), "cm"),
    ]
    for side in ("hands", "shins"):
        group = groups[f"swapped {side}"]
        noticed = sum(f"swapped_{side}" in one["notices"] for _, one in group)
        figures.append(
            Figure(
                PART,
                f"swapped {side}: noticed and corrected, of {len(group)}",
                noticed,
                "",
                "at least",
                len(group),
            )
        )
    for group_name in (name for name in groups if name.startswith("bent")):
        group = groups[group_name]
        noticed = sum(one["wasRepeated"] or _was_asked(one, "bent_knees") for _, one in group)
        off_cm = _off_cm(group, "statureM")
        figures += [
            Figure(
                PART, f"{group_name}: noticed, of {len(group)}", noticed, "", "at least", len(group)
            ),
            Figure(
                PART,
                f"{group_name}: stature off by then, worst",
                max(off_cm),
                "cm",
                "at most",
                STATURE_LIMIT_CM,
            ),
        ]
    return figures


def _accuracy(wears: str, group: Sequence[tuple[Json, Json]]) -> Iterator[Figure]:
    stature_cm, span_cm = _off_cm(group, "statureM"), _off_cm(group, "spanM")
    residuals_cm = [
        CM_PER_M * max(one["residualsM"].values()) for _, one in group if one["residualsM"]
    ]
    yield Figure(PART, f"{wears}: people", len(group), "")
    yield Figure(
        PART, f"{wears}: stature off by, worst", max(stature_cm), "cm", "at most", STATURE_LIMIT_CM
    )
    yield Figure(PART, f"{wears}: span off by, p95", quantiles(span_cm, n=20)[-1], "cm")
    yield Figure(PART, f"{wears}: span off by, worst", max(span_cm), "cm", "at most", SPAN_LIMIT_CM)
    yield Figure(
        PART,
        f"{wears}: largest residual of a goal, worst",
        max(residuals_cm),
        "cm",
        "at most",
        RESIDUAL_LIMIT_CM,
    )
    repeated = sum(one["wasRepeated"] for _, one in group)
    yield Figure(PART, f"{wears}: poses made once more", repeated, "")
    yield Figure(PART, f"{wears}: time taken, longest", max(one["tookS"] for _, one in group), "s")


def _off_cm(group: Sequence[tuple[Json, Json]], name: str) -> list[float]:
    return [CM_PER_M * abs(one[name] - wish[name]) for wish, one in group]


def _was_asked(one: Json, problem: str) -> bool:
    return any(asked.endswith(problem) for asked in one["asked"])


def _people() -> Iterator[Json]:
    percentiles = tuple(AT_PERCENTILE)
    for row, percentile, proportion in product(POPULATIONS.values(), percentiles, percentiles):
        yield {
            "statureM": row.stature[percentile],
            "spanM": row.span(percentile, proportion),
            "tabledEyesM": row.eyes[percentile],
        }


def _wish(person: Json, seed: int, wears: str, **fields: Any) -> Json:
    measures = {name: person[name] for name in ("statureM", "spanM")}
    noise = {"noiseM": NOISE_M, "noiseRad": NOISE_RAD}
    return {**measures, **noise, "seed": seed, "wears": wears, "differing": 1, **fields}


def _usual() -> Iterator[tuple[str, Json]]:
    for wears, (number, person), seed in product(WEARS, enumerate(_people()), SEEDS):
        yield wears, _wish(person, 100 * number + seed, wears)


def _with_tabled_eyes() -> Iterator[tuple[str, Json]]:
    for number, person in enumerate(_people()):
        yield (
            "tabled eyes",
            _wish(person, 7 + number, "shins", eyeHeightM=person["tabledEyesM"]),
        )


def _swapped() -> Iterator[tuple[str, Json]]:
    for side, (number, person) in product(("hands", "shins"), enumerate(_people())):
        yield f"swapped {side}", _wish(person, 31 + number, "shins", swapped=side)


def _bent() -> Iterator[tuple[str, Json]]:
    for during, (number, person) in product(
        (("n_pose",), ("t_pose",), ("n_pose", "t_pose")), enumerate(_people())
    ):
        told = " and ".join(step[0].upper() for step in during)
        bends = {"during": during, "by": BENT}
        yield f"bent knees in {told}", _wish(person, 53 + number, "shins", bends=bends)


def _calibrated(people: Sequence[Json]) -> list[Json]:
    install_packages(FRONTEND)
    script = Path(__file__).with_suffix(".mjs")
    with tempfile.TemporaryDirectory(prefix="reembody-calibration-") as folder:
        file = Path(folder, "people.json")
        file.write_text(json.dumps(people), encoding="utf-8")
        found: list[Json] = json.loads(
            run_node(str(script), str(FRONTEND), str(file), cwd=FRONTEND)
        )
    return found
