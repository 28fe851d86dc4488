"""Read a Motive CSV as a capture: its skeleton, else its rigid bodies, else its markers."""

from collections.abc import Iterator

import numpy as np

from app.adapters.captures.axes import turned_bodies, turned_markers, turned_rig_motion
from app.adapters.captures.capture import (
    Capture,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.motive.chosen import Chosen, choose
from app.adapters.captures.motive.conventions import Timing, length_of, time_rows
from app.adapters.captures.motive.head import Head, read_head
from app.adapters.captures.motive.hierarchy import parents_first
from app.adapters.captures.motive.skeleton import skeleton_motion
from app.adapters.captures.motive.values import TakeValues, read_values
from app.adapters.captures.tables import check_places, csv_rows, unseen
from app.adapters.captures.text import text_lines
from app.adapters.captures.units import chosen_axes
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray

_Y_UP = Convention("y up, right-handed", "format")


def read_motive(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read a CSV export of Motive.

    Raises:
        CaptureError: the file cannot be read; the error gives the line and the reason.
    """
    del name
    rows: Iterator[tuple[int, list[str]]] = csv_rows(text_lines(data))
    head = read_head(rows, limits)
    chosen = choose(head, limits)
    values = read_values(rows, head, chosen.tracks, limits)
    timing = time_rows(head, values, limits)
    scale, length = length_of(head, values, reading)
    places_m = values.places * scale
    check_places(places_m, values.lines, [track.name for track in chosen.tracks])
    up = reading.up or "y"
    motion: RigMotion | MarkerMotion | BodyMotion
    notes: list[str] = []
    if chosen.kind == "skeleton":
        rig_motion, notes = _skeleton(head, chosen, values, timing, places_m, limits)
        motion = turned_rig_motion(rig_motion, up)
    elif chosen.kind == "bodies":
        motion = turned_bodies(_bodies(chosen, values, timing, places_m), up)
    else:
        markers = MarkerMotion(chosen.names, timing.rate_hz, _on_grid(places_m, timing))
        motion = turned_markers(markers, up)
    conventions = Conventions(
        length=length,
        axes=chosen_axes(reading, _Y_UP),
        rotations=values.turned_by,
        rate=timing.rate,
    )
    all_notes = (*chosen.notes, *timing.notes, *notes, *_length_notes(head, len(values.lines)))
    return Capture("motive-csv", motion, conventions, all_notes)


def _skeleton(
    head: Head,
    chosen: Chosen,
    values: TakeValues,
    timing: Timing,
    places_m: FloatArray,
    limits: Limits,
) -> tuple[RigMotion, list[str]]:
    order = parents_first(chosen.parents, chosen.names, limits)
    at = {joint: place for place, joint in enumerate(order)}
    return skeleton_motion(
        [chosen.names[joint] for joint in order],
        [at.get(chosen.parents[joint], -1) for joint in order],
        _on_grid(places_m[:, order], timing),
        _on_grid(values.rotations[:, order], timing),
        timing.rate_hz,
        local=head.local,
    )


def _bodies(chosen: Chosen, values: TakeValues, timing: Timing, places_m: FloatArray) -> BodyMotion:
    missing = unseen(places_m, values.rotations)[..., np.newaxis]
    return BodyMotion(
        names=chosen.names,
        times_s=timing.slots / timing.rate_hz,
        positions_m=np.where(missing, np.nan, places_m),
        rotations=np.where(missing, np.nan, values.rotations),
    )


def _on_grid(values: FloatArray, timing: Timing) -> FloatArray:
    if timing.frame_count == len(values):
        return values
    spread = np.full((timing.frame_count, *values.shape[1:]), np.nan)
    spread[timing.slots] = values
    return spread


def _length_notes(head: Head, rows: int) -> list[str]:
    stated = head.settings.get("total exported frames", "")
    if stated.isascii() and stated.isdecimal() and len(stated) < 16 and int(stated) != rows:
        return [f"The settings state {stated} exported frames, the file has {rows}."]
    return []
