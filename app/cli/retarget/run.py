"""Retarget a capture to an avatar from the command line."""

from dataclasses import dataclass
from pathlib import Path

from app.adapters.captures import WRITERS
from app.cli.outputs import require_output
from app.cli.retarget.inputs import (
    Avatar,
    Clip,
    ground_along,
    read_avatar,
    read_clip,
    reading_of,
)
from app.science.anatomy import Notice
from app.science.retargeting import (
    Flat,
    Ground,
    Retargeted,
    Retargeter,
    check_joint_map,
    retarget_motion,
)
from app.science.rig import RigMotion
from app.whole_files import write_whole

_WRITERS = {one.suffix: one for one in WRITERS}


@dataclass(frozen=True, kw_only=True)
class RetargetOrder:
    """The options of the command `retarget`.

    Attributes:
        clip: the capture.
        to: `165cm` and the like, or a file with a skeleton.
        out: file to write, its ending that of a writer's format; None to only measure.
        ground: see `app.cli.retarget.inputs`.
        lock_feet: keep the feet in place while they are on the ground.
        joint_map: JSON file for the clip; None to match joints by name.
        skeleton: ASF of an AMC; None to take the one in the same folder.
        unit: metres per unit of the clip; None to determine it from the file.
        up: the clip's upward axis; None to determine it from the file.
    """

    clip: Path
    to: str
    out: Path | None = None
    ground: str = "flat"
    lock_feet: bool = False
    joint_map: Path | None = None
    skeleton: Path | None = None
    unit: float | None = None
    up: str | None = None


@dataclass(frozen=True, eq=False)
class Done:
    """The result of a retargeting, with its options, the clip and the avatar."""

    order: RetargetOrder
    clip: Clip
    avatar: Avatar
    result: Retargeted

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What anatomy does not allow, of the capture, of its walk, and of the avatar."""
        return (*self.clip.notices, *self.result.notices, *self.avatar.notices)


def carry_out(order: RetargetOrder) -> Done:
    """Retarget a clip, and write the result if an output file is given.

    Raises:
        ValueError: some input cannot be used; nothing is written.
        OSError: a file cannot be opened or written; no incomplete file is left.
    """
    _check_out(order)
    along = ground_along(order.ground)
    avatar = read_avatar(order.to)
    reading = reading_of(order.skeleton, order.unit, order.up)
    clip = read_clip(order.clip, reading, order.joint_map)
    check_joint_map(clip.motion.rig, clip.joint_map)
    check_joint_map(avatar.rig, avatar.joint_map)
    bodies = (clip.joint_map, avatar.rig, avatar.joint_map)
    ground: Ground = Flat()
    if along is not None:
        scale = Retargeter(clip.motion.rig, *bodies).scale
        ground = along(scale * clip.motion.root_positions_m)
    result = retarget_motion(clip.motion, *bodies, ground=ground, lock=order.lock_feet)
    for notice in result.notices:
        if notice.action == "refused":
            raise ValueError(f"{order.clip}: {notice.sentence}")
    if order.out is not None:
        write_motion(order.out, result.motion)
    return Done(order, clip, avatar, result)


def write_motion(path: Path, motion: RigMotion) -> None:
    """Write a motion atomically in the format of the file's ending; raise OSError."""
    pieces = _WRITERS[path.suffix.lower()].write(motion)
    write_whole(path, lambda file: file.writelines(piece.encode() for piece in pieces))


def _check_out(order: RetargetOrder) -> None:
    if order.out is None:
        return
    if order.out.suffix.lower() not in _WRITERS:
        valid = " or ".join(_WRITERS)
        raise ValueError(f"--out {order.out}: names ending with {valid} are valid")
    require_output(order.out, order.to, order.joint_map, order.skeleton)
    if order.out.exists() and order.clip.exists() and order.out.samefile(order.clip):
        raise ValueError(f"--out {order.out}: that is the clip itself, give another name")
