"""Run `reembody tracking align`: follow two recorded streams, and move a third."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.cli.outputs import require_output
from app.cli.tracking.inputs import read_poses, write_poses
from app.science.alignment import Alignment, PoseStream, Watched, fit_alignment, follow


@dataclass(frozen=True)
class AlignOrder:
    """What to align: the head by the headset and by a tracker; and a tracker to move to a file."""

    headset: Path
    tracker: Path
    move: Path | None = None
    out: Path | None = None


@dataclass(frozen=True, eq=False)
class Moved:
    """How many samples of the other tracker were written, and for how many nothing held."""

    out: Path
    written: int
    left_out: int


@dataclass(frozen=True, eq=False)
class Aligned:
    """What was found: each change with its time, in order. The last one may be a loss."""

    order: AlignOrder
    headset: PoseStream
    tracker: PoseStream
    changes: tuple[tuple[float, Watched], ...]
    moved: Moved | None

    @property
    def last(self) -> Alignment | None:
        """The newest alignment; None if the tracker moved and nothing was found since."""
        return self.changes[-1][1].alignment


def carry_out(order: AlignOrder) -> Aligned:
    """Align the streams as they would be aligned while they come in.

    Raises:
        ValueError: a file cannot be used, or its movement shows no alignment.
        OSError: a file cannot be read or written.
    """
    require_output(order.out, order.headset, order.tracker, order.move)
    headset, tracker = read_poses(order.headset), read_poses(order.tracker)
    other = None if order.move is None else read_poses(order.move)
    changes = tuple(follow(headset, tracker))
    if not changes:
        # Too short to be followed, or refused: then this says why.
        found = fit_alignment(headset, tracker)
        changes = ((found.end_s, Watched(found, True, found.start_s, found.end_s, "first")),)
    moved = None
    if other is not None and order.out is not None:
        moved = _move(other, changes, order.out)
    return Aligned(order, headset, tracker, changes, moved)


def _move(other: PoseStream, changes: tuple[tuple[float, Watched], ...], out: Path) -> Moved:
    """Bring each sample over by the alignment that was the newest then.

    The first alignment also serves what came before it. After a jump the new one does, although it
    was found a second later; where the tracker moved, nothing is known until the next.
    """
    parts = []
    for start_s, end_s, alignment in _validity(changes):
        shift_s = alignment.mount.delay_s
        part = other.between(start_s + shift_s, np.nextafter(end_s + shift_s, -np.inf))
        brought = alignment.to_headset(part.times_s, part.positions_m, part.rotations)
        parts.append((*brought, part.weights))
    columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
    # A new estimate of the delay may bring two samples at a change out of order.
    rising = columns[0] > np.maximum.accumulate(np.insert(columns[0][:-1], 0, -np.inf))
    written = PoseStream.of(*(column[rising] for column in columns))
    write_poses(out, written)
    return Moved(out, len(written.times_s), len(other.times_s) - len(written.times_s))


def _validity(
    changes: tuple[tuple[float, Watched], ...],
) -> list[tuple[float, float, Alignment]]:
    """Return from when to when each alignment is used, by the headset's clock."""
    parts: list[tuple[float, float, Alignment]] = []
    for number, (at_s, watched) in enumerate(changes):
        if watched.alignment is None or not watched.holds:
            continue
        ends = [
            later_s if later.change == "refit" else later.since_s
            for later_s, later in changes[number + 1 : number + 2]
        ]
        start_s = watched.since_s if watched.change in {"first", "recentred"} else at_s
        parts.append((start_s, ends[0] if ends else np.inf, watched.alignment))
    first = parts[0]
    return [(-np.inf, first[1], first[2]), *parts[1:]]
