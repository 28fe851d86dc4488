"""The columns of contacts.csv, completions.csv, the files of joint errors and samples/*.csv."""

from app.features.results.analysis.codebook.column import (
    Column,
    Describe,
    phase_columns,
    session_columns,
)
from app.features.results.analysis.codebook.equipment import epoch_column, mapped_columns
from app.science.skeleton import FINGER_PARTS, JOINT_NAMES

_C = Describe("contacts")
_T = Describe("completions")
_J = Describe("joint_errors")
_K = Describe("joint_error_course")
_M = Describe("samples")
_F = Describe("fingers")
STREAMS = ("target", "actual")

CONTACTS: tuple[Column, ...] = (
    *session_columns("contacts"),
    *phase_columns("contacts"),
    _C.text("surface", "What was touched, such as hand/2/left."),
    _C.text("surface_kind", "What touching it means.", "panel, side, target, start"),
    _C.integer("box", "The box, as numbered above it.", levels="1 to 4"),
    _C.text("side", "Side of the box.", "left, right, top, bottom, front_rim, front, back"),
    _C.text(
        "body_part",
        "The body part, by its Unity HumanBodyBones name: a finger part, such as "
        "RightThumbDistal, in sessions that record fingers; otherwise fingers count as the hand.",
    ),
    _C.text(
        "effect",
        "What the task made of it.",
        "green, out_of_order, wrong_part, early, side, target, start, none",
    ),
    epoch_column("contacts"),
    _C.number("begin_s", "Begin on the client's monotonic clock.", "s"),
    _C.number("end_s", "End on the client's monotonic clock.", "s"),
    _C.number("begin_active_s", "Begin in active time of the phase.", "s", "0 and up"),
    _C.number("end_active_s", "End in active time of the phase.", "s", "0 and up"),
    _C.number(
        "duration_s",
        "Length in active time. Contacts of several parts with one side overlap: their sum is not "
        "the time that the side was red.",
        "s",
        "0 and up",
    ),
    *mapped_columns("contacts", "begin_utc", "Begin"),
)

COMPLETIONS: tuple[Column, ...] = (
    *session_columns("completions"),
    *phase_columns("completions"),
    _T.integer("number", "Which completed task of the phase.", levels="1 and up"),
    epoch_column("completions"),
    _T.number("at_s", "When, on the client's monotonic clock.", "s"),
    _T.number("active_s", "When, in active time of the phase.", "s", "0 and up"),
    _T.number("duration_s", "Active time since the one before, or the start.", "s", "0 and up"),
    _T.text("panel_order", "Boxes in the order touched, separated by spaces."),
    _T.integer("out_of_order_touches", "Panels touched out of order.", levels="0 and up"),
    *mapped_columns("completions", "at_utc", "When"),
)


def _reference_column(table: str) -> Column:
    return Describe(table).text(
        "reference",
        "What the body is compared with: what it was asked for at that moment, or the delayed "
        "command. A delayed copy is asked for the participant's pose; an avatar moved by physics "
        "for what its hinges can make of it, before their limits take anything away.",
        "present, command",
    )


JOINT_ERRORS: tuple[Column, ...] = (
    *session_columns("joint_errors"),
    *phase_columns("joint_errors"),
    _reference_column("joint_errors"),
    _J.text(
        "joint",
        "The joint, by its Unity HumanBodyBones name; the hips carry no delay. Finger parts follow "
        "in sessions that record them. A joint without a "
        "hinge, such as a physics avatar's shoulder, is asked for nothing: its figures are empty.",
    ),
    _J.text(
        "axis",
        "The whole angle, or a part of the signed rotation vector along an axis of the joint's "
        "parent.",
        "angle, x, y, z",
    ),
    _J.number(
        "mean_deg", "Mean over active samples; signed for x, y, z.", "deg", "from -180 to 180"
    ),
    _J.number("rms_deg", "Root of the mean square.", "deg", "0 to 180"),
    _J.number("p95_deg", "95th percentile of the absolute value.", "deg", "0 to 180"),
    _J.number("max_deg", "Largest absolute value.", "deg", "0 to 180"),
    _J.number(
        "clipped_share",
        "Share of the samples in which the limits of the joint's hinges took something from what "
        "was asked for: of the hinge that lies along this axis in the T-pose, or for the angle of "
        "any of them. What they took is part of the error. Empty for a delayed copy, and where no "
        "hinge turns, as in a locked limb.",
        "1",
        "0 to 1",
    ),
    _J.integer("samples", "Samples that count.", levels="0 and up"),
    _J.integer("excluded", "Samples left out because they were not usable.", levels="0 and up"),
)

JOINT_ERROR_COURSE: tuple[Column, ...] = (
    *session_columns("joint_error_course"),
    *phase_columns("joint_error_course"),
    _reference_column("joint_error_course"),
    _K.number("begin_active_s", "Begin of the bin in active time of the phase.", "s", "0 and up"),
    _K.number(
        "end_active_s", "Its end; a phase may be over before its last bin is.", "s", "above 0"
    ),
    _K.number(
        "mean_deg",
        "Mean whole angle over all samples in the bin, a sample being one joint of the body, not "
        "of its fingers, in one frame. The mean of the bins, weighted by samples, is the mean of "
        "the phase: that of the angles in joint_errors, each joint weighted by its samples.",
        "deg",
        "0 to 180",
    ),
    _K.integer("samples", "Samples that count: joints times frames.", levels="0 and up"),
)


def _stream_columns(stream: str, what: str) -> tuple[Column, ...]:
    root = tuple(
        _M.number(
            f"{stream}_root_{axis}_m", f"Hips of the {what}, world {axis}. Single precision.", "m"
        )
        for axis in "xyz"
    )
    rotations = tuple(
        _M.number(
            f"{stream}_{joint}_q{part}",
            f"{joint} of the {what}: quaternion part {part} of the local rotation (the hips' from "
            "the world). Single precision.",
            levels="from -1 to 1",
        )
        for joint in JOINT_NAMES
        for part in "wxyz"
    )
    return (*root, *rotations)


def _frame_columns(describe: Describe) -> tuple[Column, ...]:
    return (
        describe.boolean("simulated", "Whether a simulation made the data."),
        describe.text(
            "avatar", "How the body that the participant saw was moved.", "delayed_copy, physics"
        ),
        describe.integer("epoch", "Run of the client: a restart takes a new one."),
        describe.integer(
            "seq",
            "Frame within the epoch; the frames of all streams at one moment have the same seq.",
        ),
        describe.integer("phase_id", "The phase; 0 outside phases.", levels="0 and up"),
        describe.number("t_s", "Time of the frame on the client's monotonic clock.", "s"),
        describe.boolean("active", "Whether the phase's clock ran."),
        describe.boolean(
            "flagged",
            "Whether a stream's frame holds a value that is not a number, or a rotation that is "
            "not of unit length. It stands as it came and enters no summary.",
        ),
    )


def _finger_columns(stream: str, what: str) -> tuple[Column, ...]:
    return tuple(
        _F.number(
            f"{stream}_{part}_q{component}",
            f"{part} of the {what}: quaternion part {component} of the rotation relative to the "
            "part above it, in the T-pose's axes; NaN for a hand that is not tracked. Single "
            "precision.",
            levels="from -1 to 1",
        )
        for part in FINGER_PARTS
        for component in "wxyz"
    )


SAMPLES: tuple[Column, ...] = (
    *_frame_columns(_M),
    *_stream_columns("target", "target, what the tracking asks for"),
    *_stream_columns("actual", "actual body, what the participant sees"),
)
FINGER_SAMPLES: tuple[Column, ...] = (
    *_frame_columns(_F),
    *_finger_columns("target", "target, what the tracking asks for"),
    *_finger_columns("actual", "actual body, what the participant sees"),
)
