"""Figures of the measures with each body, for studies whose conditions share a latency.

Each covers one latency: bodies at one latency are compared, so that conditions are never mixed.
"""

from collections.abc import Iterator
from dataclasses import replace

import pandas as pd

from app.features.results.analysis.figures.by_latency import (
    Across,
    drawn_rows,
    latency_figure,
    per_participant,
)
from app.features.results.analysis.figures.drawing import Drawing, Group, count_note, drawn
from app.features.results.analysis.figures.embodiment import COMPONENTS
from app.features.results.analysis.figures.joint_errors import task_angles
from app.features.results.analysis.material import Material
from app.protocol import COUNTED_KINDS

WORDS = (
    "Thin lines are participants; the thick mark is their mean with its 95 % confidence interval "
    "(t distribution). The shape beside it is the distribution of 5 or more participants; n "
    "is below each body. Bodies have no order: read differences, not slopes."
)
_FEWEST = 2


def by_body_drawings(
    filtered: Material, group: Group, *, invalid: bool = False
) -> Iterator[Drawing]:
    """Yield the measures of a group with each body, for every latency that several bodies share.

    `filtered`: not limited to one body. Nothing is yielded for a study that does not vary bodies,
    or before several bodies have data.
    """
    for latency_ms in filtered.shared_latencies_ms:
        shared = filtered.at_latency(latency_ms)
        for key, title, axis, unit, rows in _measures(shared, group, invalid=invalid):
            worn = [one for one in filtered.bodies if (rows["body"] == one).any()]
            if len(worn) < _FEWEST:
                continue
            across = Across("body", "body", "", tuple(worn))
            places = {name: float(at) for at, name in enumerate(worn)}
            values = per_participant(rows.assign(body=rows["body"].map(places)), "value", "body")
            n = int(values["participant_code"].nunique())
            figure = latency_figure(values, axis=axis, unit=unit, across=across)
            data = drawn_rows(values, unit, across)
            data["body"] = [worn[int(at)] for at in data["body"]]
            drawing = drawn(
                f"{key}_bodies_{latency_ms:g}ms",
                f"{title} by body, at {latency_ms:g} ms",
                f"{WORDS} {count_note(n)}",
                n,
                figure,
                data.assign(latency_ms=latency_ms),
            )
            yield replace(drawing, every_body=True).of_group(group)


_Rows = tuple[str, str, str, str, pd.DataFrame]


def _measures(shared: Material, group: Group, *, invalid: bool) -> Iterator[_Rows]:
    """Yield key, title, axis, unit and rows (with `value` and `body`) of a group's measures."""
    if group == "embodiment":
        scores = shared.counting(shared.scores, invalid=invalid).dropna(subset=["limb", "value"])
        for score, (title, axis) in COMPONENTS.items():
            own = scores[scores["score"] == score]
            yield f"embodiment_{score}", title, f"{axis} (points)", "points", own
    if group == "tasks":
        phases = shared.counting(shared.phases, invalid=invalid)
        tasks = phases[phases["phase_kind"].isin(COUNTED_KINDS)]
        done = tasks.astype({"completions": "float64"}).rename(columns={"completions": "value"})
        yield "completions", "Completed tasks", "completed tasks (per phase)", "tasks", done
        red = tasks.rename(columns={"side_red_s": "value"})
        yield "contact_time", "Contact time", "sides of boxes red (s per phase)", "s", red
    if group == "movement":
        errors = task_angles(shared.counting(shared.errors, invalid=invalid))
        angles = errors.rename(columns={"mean_deg": "value"})
        yield "joint_error", "Joint error", "mean joint error (deg)", "deg", angles
