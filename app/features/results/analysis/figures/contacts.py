"""The figure of contact times with sides of boxes, by side and by body part."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd
import plotly.graph_objects as go

from app.features.results.analysis.figures.by_latency import LIMBS
from app.features.results.analysis.figures.drawing import (
    MIN_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    limb_note,
    participants,
    too_few,
)
from app.features.results.analysis.figures.fingers import (
    by_finger,
    fingers_note,
    in_some_phases,
    is_of_fingers,
)
from app.features.results.analysis.figures.theme import COLOURS, PATTERNS, hatched, new_figure
from app.features.results.analysis.tables.tasks import red_spans, total_s
from app.protocol import COUNTED_KINDS

Contact = tuple[str, float, float]
KEY, TITLE = "contacts", "Time at the sides of the boxes by added latency"
WHAT = (
    "Left: how long sides were red, the union over the body parts that touched a side, summed over "
    "boxes. Right: contact time of each body part, which overlaps with others and must not be "
    "summed to the red time. Mean active seconds per phase over participants; a phase without a "
    "contact counts as 0."
)


def contacts_drawing(phases: pd.DataFrame, contacts: pd.DataFrame) -> Drawing:
    """Draw mean contact times per phase, from valid rows of the tables of phases and contacts.

    The phases say whether their fingers were recorded (`mark_fingers`).
    """
    tasks = phases[phases["phase_kind"].isin(COUNTED_KINDS)]
    sides = contacts[contacts["surface_kind"] == "side"]
    n = participants(tasks)
    if n < MIN_PARTICIPANTS:
        return too_few(KEY, TITLE, WHAT, n, "a finished hand or foot phase")
    if sides.empty:
        empty = "No side of a box was touched in any valid phase."
        return Drawing(KEY, TITLE, WHAT, n, empty=empty)
    panels = (("sides, red time", _side_times(sides)), ("body parts", _part_times(sides, tasks)))
    limbs = [limb for limb in LIMBS if (tasks["limb"] == limb).any()]
    figure = new_figure(
        rows=len(limbs),
        titles=tuple(f"{limb.capitalize()}: {name}" for limb in limbs for name, _ in panels),
        shared_yaxes=True,
    )
    rows = []
    for row, limb in enumerate(limbs, start=1):
        for column, (name, times) in enumerate(panels, start=1):
            means = mean_times(tasks[tasks["limb"] == limb], times)
            rows.append(_as_rows(means, limb, name))
            for bar in _bars(means, legend=row == 1 and column == 1):
                figure.add_trace(bar, row=row, col=column)
        figure.update_yaxes(title_text="time (s per phase)", row=row, col=1)
        figure.update_xaxes(title_text="side", row=row, col=1)
        figure.update_xaxes(title_text="body part", row=row, col=2)
    figure.update_layout(barmode="group", height=330 * len(limbs))
    caption = f"{WHAT} {count_note(n)} {fingers_note(tasks)} {limb_note(tasks)}"
    return drawn(KEY, TITLE, caption, n, figure, pd.concat(rows, ignore_index=True))


def _side_times(sides: pd.DataFrame) -> pd.DataFrame:
    """Return the red time by phase and side over all boxes: session_id, phase_id, what, time_s."""
    rows = []
    for key, contacts in _grouped(sides, "session_id", "phase_id").items():
        for side, red in red_spans(contacts).items():
            rows.append((*key, side.rpartition("/")[2], total_s(red)))
    return _times(rows)


def _part_times(sides: pd.DataFrame, tasks: pd.DataFrame) -> pd.DataFrame:
    """Return the contact time by phase and body part: the union of its contacts per side."""
    rows = []
    named = by_finger(sides, tasks)
    for key, contacts in _grouped(named, "session_id", "phase_id", "body_part").items():
        rows.append((*key, sum(total_s(red) for red in red_spans(contacts).values())))
    return _times(rows)


def part_side_times(sides: pd.DataFrame) -> pd.DataFrame:
    """Return the contact time by phase, body part and side over all boxes, in seconds."""
    rows = []
    for key, contacts in _grouped(sides, "session_id", "phase_id", "body_part").items():
        for side, red in red_spans(contacts).items():
            rows.append((*key, side.rpartition("/")[2], total_s(red)))
    names = ["session_id", "phase_id", "body_part", "side"]
    frame = pd.DataFrame(rows, columns=[*names, "time_s"])
    return frame.groupby(names)["time_s"].sum().reset_index()


def _grouped(sides: pd.DataFrame, *by: str) -> dict[tuple[Any, ...], list[Contact]]:
    """Group the contacts by the columns `by`.

    The groups are plain lists, because a thousand sessions have many small groups.
    """
    names = [*by, "surface", "begin_active_s", "end_active_s"]
    found: dict[tuple[Any, ...], list[Contact]] = {}
    for row in zip(*(sides[name].tolist() for name in names), strict=True):
        found.setdefault(row[: len(by)], []).append(row[len(by) :])
    return found


def _times(rows: Sequence[tuple[Any, ...]]) -> pd.DataFrame:
    frame = pd.DataFrame(rows, columns=["session_id", "phase_id", "what", "time_s"])
    return frame.groupby(["session_id", "phase_id", "what"])["time_s"].sum().reset_index()


@dataclass(frozen=True)
class MeanTimes:
    """Mean seconds per phase, and of how many participants each is the mean.

    In both tables the rows are latency_ms, the columns the values of `what`. A mean is not a number
    where no participant has a phase in which the part could be known.
    """

    mean_s: pd.DataFrame
    n: pd.DataFrame

    def cells(self) -> Iterator[tuple[float, str, float, int]]:
        """Yield latency_ms, `what`, the mean and n of every cell."""
        for (latency, means), (_, counts) in zip(
            self.mean_s.iterrows(), self.n.iterrows(), strict=True
        ):
            for (what, mean_s), n in zip(means.items(), counts, strict=True):
                yield float(str(latency)), str(what), float(mean_s), int(n)


def mean_times(tasks: pd.DataFrame, times: pd.DataFrame) -> MeanTimes:
    """Return the mean over participants of their seconds per phase, for each value of `what`.

    A phase without a contact counts as 0. Fingers and palms are means over the phases in which
    fingers were recorded. If those are only some of the phases, hands are means over the others.
    """
    keys = ["session_id", "phase_id"]
    wide = times.pivot(index=keys, columns="what", values="time_s")
    own = tasks[[*keys, "participant_code", "latency_ms", "fingers"]]
    own = own.merge(wide, on=keys, how="left")
    tracked, apart = own["fingers"].astype(bool), in_some_phases(tasks)
    own = own.drop(columns=[*keys, "fingers"]).fillna(0.0)
    for what in wide.columns:
        if is_of_fingers(str(what)):
            own[what] = own[what].where(tracked)
        elif apart and "Hand" in str(what):
            own[what] = own[what].where(~tracked)
    by_person = own.groupby(["latency_ms", "participant_code"]).mean()
    each = by_person.groupby(level="latency_ms")
    touched = by_person.sum() > 0
    return MeanTimes(each.mean().loc[:, touched], each.count().loc[:, touched])


def _as_rows(means: MeanTimes, limb: str, what: str) -> pd.DataFrame:
    rows = [
        (limb, what, of, latency_ms, mean_s, n)
        for latency_ms, of, mean_s, n in means.cells()
        if n > 0
    ]
    names = ["limb", "what", "of", "latency_ms", "mean_s_per_phase", "n"]
    return pd.DataFrame(rows, columns=names)


def _bars(means: MeanTimes, *, legend: bool) -> list[go.Bar]:
    return [
        go.Bar(
            x=[str(name).replace("_", " ") for name in means.mean_s.columns],
            y=[None if pd.isna(one) else float(one) for one in means.mean_s.loc[latency]],
            customdata=means.n.loc[latency].tolist(),
            name=f"{latency:g} ms",
            legendgroup=f"{latency:g}",
            showlegend=legend,
            marker=hatched(COLOURS[place % len(COLOURS)], PATTERNS[place % len(PATTERNS)]),
            hovertemplate=f"%{{x}} at {latency:g} ms: %{{y:.2f}} s per phase, "
            "n = %{customdata}<extra></extra>",
        )
        for place, latency in enumerate(means.mean_s.index)
    ]
