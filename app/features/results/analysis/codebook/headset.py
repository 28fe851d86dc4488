"""The columns of goal_states.csv and body_calibrations.csv."""

from app.features.results.analysis.codebook.column import Column, Describe, session_columns
from app.features.results.analysis.codebook.equipment import epoch_column

_G = Describe("goal_states")
_B = Describe("body_calibrations")
_STATES = "tracked, inferred, lost"
_PARTS = {
    "hips": "hips",
    "head": "head",
    "left_hand": "left hand",
    "right_hand": "right hand",
    "left_shin": "left shin",
    "right_shin": "right shin",
}

GOAL_STATES: tuple[Column, ...] = (
    *session_columns("goal_states"),
    epoch_column("goal_states"),
    _G.integer(
        "frame_seq",
        "First frame of the run to which it applies, until the next row: seq of samples.",
        levels="0 and up",
    ),
    _G.number("client_t_s", "When the headset noticed, on the client's monotonic clock.", "s"),
    _G.text("source", "Where the poses come from, such as controllers, hands, body or script."),
    *(
        _G.text(
            f"state_{name}",
            f"How the {part} is known: measured, computed from other parts, or not at all. "
            "Contacts of a foot are measurements only while its shin is tracked."
            if "shin" in name
            else f"How the {part} is known: measured, computed from other parts, or not at all.",
            _STATES,
        )
        for name, part in _PARTS.items()
    ),
)

BODY_CALIBRATIONS: tuple[Column, ...] = (
    *session_columns("body_calibrations"),
    epoch_column("body_calibrations"),
    _B.integer("seq", "Number of the report; its rows belong together.", levels="0 and up"),
    _B.number("client_t_s", "When it was completed, on the client's monotonic clock.", "s"),
    _B.integer(
        "revision",
        "Number of the operator's order that it answers; empty if the headset made it by itself.",
        levels="0 and up",
    ),
    _B.text("cause", "Why the headset calibrated.", "first, order, error, reset"),
    _B.number("stature_m", "Height of the participant, as measured.", "m", "0 to 10"),
    _B.number("span_m", "Span of the arms, as measured.", "m", "0 to 10"),
    _B.number("eye_height_m", "Height of the eyes while standing.", "m", "0 to 10"),
    _B.number(
        "upper_arm_m",
        "Length of the upper arms, as measured, from shoulder to elbow; empty if it was not.",
        "m",
        "0 to 10",
    ),
    _B.number(
        "forearm_m",
        "Length of the forearms, as measured, from elbow to wrist; empty if it was not.",
        "m",
        "0 to 10",
    ),
    _B.text("notices", "What the headset noticed, such as swapped_hands or bent_knees."),
    _B.text(
        "goal",
        "Part of the body that the rest of the row is about; empty if the headset named none.",
        "Hips, Head, LeftHand, RightHand, LeftLowerLeg, RightLowerLeg",
    ),
    _B.text("source", "What tracked it."),
    _B.number(
        "residual_m", "How far it was off in the poses that test the calibration.", "m", "0 to 10"
    ),
    *(
        _B.number(f"offset_{axis}_m", f"Place of its joint in its tracker's frame, {axis}.", "m")
        for axis in "xyz"
    ),
    *(
        _B.number(f"offset_q{axis}", f"Orientation there, as a quaternion: {axis}.", "", "-1 to 1")
        for axis in "wxyz"
    ),
)
