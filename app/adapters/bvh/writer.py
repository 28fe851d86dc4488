"""Format a `BvhClip` as BVH text."""

import numpy as np

from app.adapters.bvh.clip import BvhClip, BvhError
from app.science.rotations import FloatArray, to_euler


def format_bvh(clip: BvhClip, *, metres_per_unit: float) -> str:
    """Format a clip as BVH text in units of `metres_per_unit`, with the clip's own channel orders.

    Angles may differ from those originally read if another set of angles gives the same rotation;
    reading the text gives the same poses to 1e-9.

    Raises:
        BvhError: a joint has one or two rotation channels, which cannot represent every rotation.
    """
    for name, channels in zip(clip.names, clip.channels, strict=True):
        if len(_order(channels)) not in {0, 3}:
            raise BvhError(
                0, f"joint {name!r} has {len(_order(channels))} rotation channels: 0 or 3."
            )
    lines = ["HIERARCHY", *_joint_lines(clip, 0, 0, metres_per_unit), "MOTION"]
    lines += [f"Frames: {clip.frame_count}", f"Frame Time: {clip.frame_time_s:.12g}"]
    values = _channel_values(clip, metres_per_unit)
    lines += [" ".join(f"{value:.12g}" for value in row) for row in values.tolist()]
    return "\n".join(lines) + "\n"


def _order(channels: tuple[str, ...]) -> str:
    return "".join(channel[0] for channel in channels if channel.endswith("rotation"))


def _joint_lines(clip: BvhClip, joint: int, depth: int, metres_per_unit: float) -> list[str]:
    pad, inner = "\t" * depth, "\t" * (depth + 1)
    channels = clip.channels[joint]
    lines = [
        f"{pad}{'JOINT' if depth else 'ROOT'} {clip.names[joint]}",
        f"{pad}{{",
        f"{inner}OFFSET {_numbers(clip.offsets_m[joint] / metres_per_unit)}",
        f"{inner}CHANNELS {len(channels)} {' '.join(channels)}".rstrip(),
    ]
    for child, parent in enumerate(clip.parents):
        if parent == joint:
            lines += _joint_lines(clip, child, depth + 1, metres_per_unit)
    for at, offset in clip.end_sites:
        if at == joint:
            numbers = _numbers(np.array(offset) / metres_per_unit)
            lines += [f"{inner}End Site", f"{inner}{{", f"{inner}\tOFFSET {numbers}", f"{inner}}}"]
    return [*lines, f"{pad}}}"]


def _written_order(clip: BvhClip, joint: int) -> list[int]:
    """Return the joints in the order of the file, each followed directly by its descendants."""
    children = [child for child, parent in enumerate(clip.parents) if parent == joint]
    return [joint, *(index for child in children for index in _written_order(clip, child))]


def _numbers(vector: FloatArray) -> str:
    return " ".join(f"{value:.12g}" for value in vector.tolist())


def _channel_values(clip: BvhClip, metres_per_unit: float) -> FloatArray:
    columns = []
    for joint in _written_order(clip, 0):
        channels = clip.channels[joint]
        order = _order(channels)
        angles = np.degrees(to_euler(order, clip.rotations[:, joint])) if order else None
        for channel in channels:
            axis = channel[0]
            if channel.endswith("position"):
                place = clip.translations_m[:, joint, "XYZ".index(axis)]
                columns.append(place / metres_per_unit)
            elif angles is not None:
                columns.append(angles[:, order.index(axis)])
    return np.stack(columns, axis=1)
