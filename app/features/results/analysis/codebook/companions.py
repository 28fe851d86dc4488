"""The columns of the files in companions/."""

from app.features.results.analysis.codebook.column import Describe
from app.science.skeleton import JOINT_NAMES

_C = Describe("companions")
_HIPS = tuple(f"root_{axis}_m" for axis in "xyz")
COMPANION_POSE = (*_HIPS, *(f"{joint}_q{part}" for joint in JOINT_NAMES for part in "wxyz"))
"""The columns of a pose: the place of the hips, then every joint's rotation."""

COMPANION_FRAMES = (
    _C.boolean("simulated", "Whether a simulation made the data."),
    _C.text("avatar", "How the body that the participant saw was moved.", "delayed_copy, physics"),
    _C.text("door", "The door through which the performer came.", "osc, natnet, json"),
    _C.text("source", "The source of the performer, by its own name."),
    _C.number("source_s", "Time by the source's own clock; empty if it sends none.", "s"),
    _C.number("arrival_s", "When the packet arrived, by the server's monotonic clock.", "s"),
    _C.number(
        "mapped_s", "source_s brought to the server's monotonic clock; else the arrival.", "s"
    ),
    _C.number("sent_s", "When the pose was sent to the headset, by the server's clock.", "s"),
    _C.time("sent_at_utc", "The same, by the server's time of day."),
    *(
        _C.number(
            f"root_{axis}_m", f"Hips of the companion, in the participant's room: {axis}.", "m"
        )
        for axis in "xyz"
    ),
    *(
        _C.number(
            f"{joint}_q{part}",
            f"{joint} of the companion: quaternion part {part} of the local rotation (the hips' "
            "from the room). Single precision.",
            levels="from -1 to 1",
        )
        for joint in JOINT_NAMES
        for part in "wxyz"
    ),
)
