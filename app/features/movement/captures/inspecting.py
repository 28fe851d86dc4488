"""Summarise what a capture file contains; runs in the worker process for captures."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from app.adapters.captures import Capture
from app.features.movement.captures.opening import Opened, Store, open_files, open_stored
from app.features.movement.captures.schemas import (
    CaptureSummary,
    ConventionsView,
    ConventionView,
    SkeletonView,
)
from app.features.movement.captures.source import Source
from app.features.movement.files import compress, compressed_beside
from app.science.anatomy import sentences
from app.science.rig import BodyMotion, MarkerMotion, RigMotion

if TYPE_CHECKING:
    from app.science.fitting import Fitted

KIND: dict[type, Literal["skeleton", "markers", "bodies"]] = {
    RigMotion: "skeleton",
    MarkerMotion: "markers",
    BodyMotion: "bodies",
}


@dataclass(frozen=True)
class Inspected:
    """The summary of a parsed capture, as stored in the table `captures`."""

    format: str
    kind: Literal["skeleton", "markers", "bodies"]
    frames: int
    rate_hz: float
    duration_s: float
    tracks: int
    fingerprint: str | None
    summary: CaptureSummary


def inspect_upload(max_bytes: int, source: Source, paths: tuple[Path, ...]) -> Inspected:
    """Parse newly uploaded files and write a compressed copy next to each; raise Cannot."""
    inspected = _inspected(open_files(max_bytes, source, paths))
    for path in paths:
        compress(path, compressed_beside(path))
    return inspected


def inspect_stored(store: Store, source: Source) -> Inspected:
    """Parse a stored capture again with other conventions; raise Cannot."""
    return _inspected(open_stored(store, source))


def _inspected(opened: Opened) -> Inspected:
    motion = opened.capture.motion
    names = motion.rig.names if isinstance(motion, RigMotion) else motion.names
    return Inspected(
        format=opened.capture.format,
        kind=KIND[type(motion)],
        frames=motion.frame_count,
        rate_hz=motion.rate_hz,
        duration_s=_duration_s(motion),
        tracks=len(names),
        fingerprint=None if opened.skeleton is None else opened.skeleton.rig.fingerprint,
        summary=CaptureSummary(
            names=list(names),
            observed=_observed(motion),
            conventions=_conventions(opened.capture),
            notes=list(opened.capture.notes),
            skeleton=_skeleton(opened),
            no_skeleton=opened.no_skeleton,
        ),
    )


def _duration_s(motion: RigMotion | MarkerMotion | BodyMotion) -> float:
    if isinstance(motion, BodyMotion):
        return float(motion.times_s[-1]) if motion.frame_count else 0.0
    return max(0, motion.frame_count - 1) / motion.rate_hz if motion.rate_hz > 0.0 else 0.0


def _observed(motion: RigMotion | MarkerMotion | BodyMotion) -> float:
    if isinstance(motion, RigMotion):
        seen = motion.observed
    else:
        seen = np.isfinite(motion.positions_m[..., 0])
    return float(seen.mean()) if seen.size else 0.0


def _conventions(capture: Capture) -> ConventionsView:
    conventions = capture.conventions
    return ConventionsView(
        **{
            name: ConventionView(value=one.value, origin=one.origin)
            for name, one in (
                ("length", conventions.length),
                ("axes", conventions.axes),
                ("rotations", conventions.rotations),
                ("rate", conventions.rate),
            )
        }
    )


def _skeleton(opened: Opened) -> SkeletonView | None:
    if opened.skeleton is None:
        return None
    rig, fitted = opened.skeleton.rig, opened.fitted
    return SkeletonView(
        fingerprint=rig.fingerprint,
        origin="file" if fitted is None else "fitted",
        joints=list(rig.names),
        parents=list(rig.parents),
        unfitted=[] if fitted is None else list(fitted.unfitted),
        residual_m=None if fitted is None else _number(fitted.residual_m),
        notes=[] if fitted is None else _notes_without_notices(fitted),
        notices=list(opened.notices),
    )


def _notes_without_notices(fitted: "Fitted") -> list[str]:
    """Return the notes of a fit but its notices, which are shown on their own."""
    told = sentences(fitted.notices)
    return [note for note in fitted.notes if note not in told]


def _number(value: float) -> float | None:
    """Return the value, or None if it is not finite, because JSON in databases cannot store it."""
    return float(value) if np.isfinite(value) else None
