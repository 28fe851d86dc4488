"""The columns of what came through the doors: alignments, and files of trackers and companions."""

from app.features.results.analysis.codebook.column import Column, Describe, session_columns
from app.science.skeleton import JOINT_NAMES

_A = Describe("tracker_alignments")
_T = Describe("trackers")
_C = Describe("companions")
_WORLDS = "The tracking system's world in the headset's own world"

TRACKER_ALIGNMENTS: tuple[Column, ...] = (
    *session_columns("tracker_alignments"),
    _A.time("changed_at_utc", "When the server stored it."),
    _A.text(
        "change",
        "What became known: an alignment (first, refit, recentred: again after the headset's world "
        "had jumped), or that there is none (lost: the headset's world has jumped, moved: the "
        "tracker on the head has).",
        "first, refit, recentred, lost, moved",
    ),
    _A.number("client_t_s", "From when on, on the headset's monotonic clock.", "s"),
    _A.text("door", "The door through which the trackers came.", "osc, natnet, json"),
    _A.text("source", "Name of the source."),
    _A.text("tracker", "Name of the tracker on the headset."),
    _A.number("delay_s", "How much later the trackers show a movement than the headset does.", "s"),
    _A.number("delay_uncertainty_s", "Standard error of delay_s.", "s", "0 and up"),
    _A.number("residual_m", "Median distance of the head by both.", "m", "0 and up"),
    _A.number("residual_p95_m", "95th percentile of the same.", "m", "0 and up"),
    _A.number("residual_rad", "Median angle between the head by both.", "rad", "0 and up"),
    _A.number(
        "foot_uncertainty_m", "Standard error of a point 1.6 m from the head.", "m", "0 and up"
    ),
    _A.number("outliers", "Share of the samples that were left out as wrong.", "", "0 to 1"),
    *(_A.number(f"world_{axis}_m", f"{_WORLDS}: its origin, {axis}.", "m") for axis in "xyz"),
    *(
        _A.number(f"world_q{axis}", f"{_WORLDS}: rotation, {axis}.", "", "-1 to 1")
        for axis in "wxyz"
    ),
    *(
        _A.number(f"drift_{axis}_m_per_min", f"How fast its origin moves, {axis}.", "m/min")
        for axis in "xyz"
    ),
    _A.number(
        "reference_client_t_s",
        "When its origin is there, on the headset's monotonic clock; the drift counts from then.",
        "s",
    ),
    _A.text("jump_side", "Whose pose has jumped, if one did.", "headset, tracker"),
    _A.number("jump_m", "By how much the head by both moved apart in the jump.", "m", "0 and up"),
    _A.number("jump_rad", "By how much it turned apart.", "rad", "0 and up"),
)

TRACKER_SAMPLES: tuple[Column, ...] = (
    _T.boolean("simulated", "Whether a simulation made the data."),
    _T.text("avatar", "How the body that the participant saw was moved.", "delayed_copy, physics"),
    _T.text(
        "door",
        "The door through which it came; headset: where the headset says that the eyes are.",
        "osc, natnet, json, headset",
    ),
    _T.text("source", "Name of the source."),
    _T.text("tracker", "Name of the tracker or bone."),
    _T.boolean("tracked", "Whether the source tracks it; if not, the pose is old or guessed."),
    _T.number("source_s", "Time by the source's own clock; empty if it sends none.", "s"),
    _T.number("arrival_s", "When the packet arrived, by the server's monotonic clock.", "s"),
    _T.time("arrived_at_utc", "The same, by the server's time of day."),
    _T.number(
        "mapped_s", "source_s brought to the server's monotonic clock; else the arrival.", "s"
    ),
    _T.number(
        "mapped_uncertainty_s", "How far mapped_s may be off; empty if unknown.", "s", "0 and up"
    ),
    *(
        _T.number(f"{axis}_m", f"Position in the source's own world, y up: {axis}.", "m")
        for axis in "xyz"
    ),
    *(
        _T.number(f"q{axis}", f"Rotation there as it was sent, as a quaternion: {axis}.")
        for axis in "wxyz"
    ),
)

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
