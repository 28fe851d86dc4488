"""Figures of how participants crossed the study's road, by latency."""

from collections.abc import Iterator
from dataclasses import dataclass

import pandas as pd

from app.features.results.analysis.figures.by_latency import (
    MEANS,
    ROAD,
    drawn_rows,
    latency_figure,
    per_participant,
)
from app.features.results.analysis.figures.drawing import (
    MIN_PARTICIPANTS,
    Drawing,
    count_note,
    drawn,
    participants,
    too_few,
)

DONE = "a crossing of the road in a finished phase"


@dataclass(frozen=True)
class Measure:
    """One figure: a column of the table of crossings, its axis and its words.

    `turned_back_too`: whether crossings count that ended at the kerb where they began. `missing`:
    what no participant has where there are crossings, but none has this measure.
    """

    column: str
    title: str
    axis: str
    unit: str
    words: str
    turned_back_too: bool = False
    missing: str = DONE


MEASURES = (
    Measure(
        "gap_accepted_s",
        "Accepted gaps by added latency",
        "accepted gap (s)",
        "s",
        "Time until the first car would have been at the participant's line as they stepped onto "
        "the carriageway; crossings without a car coming are left out.",
        missing="a crossing with a car coming in a finished phase",
    ),
    Measure(
        "waited_s",
        "Waiting at the kerb by added latency",
        "waited (s per crossing)",
        "s",
        "Time stood within 1.5 m of the kerb before stepping onto the carriageway.",
    ),
    Measure(
        "least_post_encroachment_s",
        "Time margin to cars by added latency",
        "smallest post-encroachment time (s)",
        "s",
        "Smallest time between participant and car at the place that both used; crossings whose "
        "line no car used are left out.",
        missing="a crossing whose line a car used in a finished phase",
    ),
    Measure(
        "closest_m",
        "Smallest distance to cars by added latency",
        "smallest distance (m)",
        "m",
        "Smallest distance between the outlines on the carriageway; 0 if hit.",
        missing="a crossing with a car on the road in a finished phase",
    ),
    Measure(
        "collision",
        "Collisions by added latency",
        "collisions (per crossing)",
        "per crossing",
        "Share of the crossings in which a car hit the participant; those that were broken off by "
        "turning back count, too.",
        turned_back_too=True,
    ),
)


def crossings_drawings(crossings: pd.DataFrame) -> Iterator[Drawing]:
    """Draw each measure by latency, from valid rows of the table of crossings.

    A participant's value is the mean over their crossings with this latency.
    """
    on_road = crossings[crossings["steps_on_s"].notna()]
    for measure in MEASURES:
        rows = on_road if measure.turned_back_too else on_road[on_road["is_across"].astype(bool)]
        yield _drawing(
            measure, rows.dropna(subset=[measure.column]), DONE if rows.empty else measure.missing
        )


def _drawing(measure: Measure, rows: pd.DataFrame, missing: str) -> Drawing:
    key, n = f"crossing_{measure.column}", participants(rows)
    words = f"{measure.words} Values are means over each participant's crossings. {MEANS}"
    if n < MIN_PARTICIPANTS:
        return too_few(key, measure.title, words, n, missing)
    numbers = rows.astype({measure.column: "float64"}).assign(limb=ROAD)
    values = per_participant(numbers, measure.column)
    figure = latency_figure(values, axis=measure.axis, unit=measure.unit)
    # The interval of a share may reach below 0, the share cannot.
    figure.update_yaxes(rangemode="nonnegative" if measure.turned_back_too else "tozero")
    caption = f"{words} {count_note(n)} {len(rows)} crossings."
    data = drawn_rows(values, measure.unit).drop(columns="limb")
    return drawn(key, measure.title, caption, n, figure, data)
