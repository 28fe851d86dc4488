"""In the process for captures: what a page or a download asks for, as bytes.

Everything that a task needs is in its arguments, which are hashable: the same call gives the same
bytes.
"""

from pathlib import Path

from app.adapters.captures import to_bvh, to_csv
from app.features.movement.captures.avatars import Mapped, on_avatar
from app.features.movement.captures.opening import Store, open_stored
from app.features.movement.captures.preview import encode, points_of, skeleton_points
from app.features.movement.captures.schemas import ExportFormat, Shown
from app.features.movement.captures.source import Source
from app.features.movement.captures.verifying import verification_json

__all__ = ["recorded_positions", "retargeted_positions", "verification_json", "write_retargeted"]


def recorded_positions(store: Store, source: Source, shown: Shown) -> bytes:
    """Positions for a preview, as recorded or of the skeleton; raises Cannot."""
    opened = open_stored(store, source)
    if shown == "recorded":
        return encode(points_of(opened.capture.motion))
    return encode(skeleton_points(opened.moving, start_s=opened.start_s))


def retargeted_positions(mapped: Mapped, avatar: str, *, lock_feet: bool) -> bytes:
    """Positions of an avatar's joints for a preview; raises Cannot."""
    return encode(skeleton_points(on_avatar(mapped, avatar, lock_feet=lock_feet).motion))


def write_retargeted(
    mapped: Mapped, avatar: str, format_: ExportFormat, to: Path, *, lock_feet: bool
) -> None:
    """The movement on an avatar as a file of that format; raises Cannot."""
    motion = on_avatar(mapped, avatar, lock_feet=lock_feet).motion
    with to.open("w", encoding="utf-8", newline="\n") as file:
        if format_ == "csv":
            file.writelines(to_csv(motion))
        else:
            file.write(to_bvh(motion))
