"""The columns of quality.csv, doubts.csv and alarms.csv."""

from app.features.record.doubts import KINDS
from app.features.results.analysis.codebook.column import (
    Column,
    Describe,
    phase_columns,
    session_columns,
)

_Q = Describe("quality")
_A = Describe("alarms")
_D = Describe("doubts")

QUALITY: tuple[Column, ...] = (
    *session_columns("quality"),
    *phase_columns("quality"),
    _Q.text(
        "stream",
        "What the tracking asks for (target), or the body that is seen (actual); streams of their "
        "fingers where fingers are recorded.",
        "target, actual, target_fingers, actual_fingers",
    ),
    _Q.integer("frames", "Frames of active time.", levels="0 and up"),
    _Q.number("span_s", "Time between them, gaps included, on the client's clock.", "s"),
    _Q.number("frame_rate_hz", "One over the median interval between two frames.", "1/s"),
    _Q.integer(
        "gaps",
        "How often no frame came for longer than 2.5 usual intervals and 40 ms, the clock running.",
        levels="0 and up",
    ),
    _Q.number("gap_s", "Sum of the intervals that are gaps.", "s", "0 and up"),
    _Q.number("longest_gap_s", "The longest of them.", "s", "0 and up"),
    _Q.integer(
        "jumps",
        "Frames in which a joint turned faster than 2,000 deg/s, or the hips moved faster than "
        "10 m/s. A pose that is off for one frame jumps twice.",
        levels="0 and up",
    ),
    _Q.number(
        "frozen_s",
        "For how long the joint that was frozen longest kept the same rotation to the last bit, "
        "though it was lively before and others moved; a second or more at a time.",
        "s",
        "0 and up",
    ),
    _Q.text("frozen_joints", "The joints that were frozen at any time, separated by spaces."),
    _Q.integer(
        "non_unit",
        "Frames with a rotation whose length is off 1 by more than 0.001.",
        "",
        "0 and up",
    ),
    _Q.integer(
        "non_finite",
        "Frames with a value that is not a number, or with hips more than 1 km away.",
        "",
        "0 and up",
    ),
    _Q.integer(
        "backwards",
        "Frames that are not later than the one before, or whose time is no number.",
        "",
        "0 and up",
    ),
)

DOUBTS: tuple[Column, ...] = (
    *session_columns("doubts"),
    _D.integer(
        "phase_id",
        "The phase that does not count because of it; empty where it is the whole session.",
        levels="1 and up",
    ),
    _D.text("doubt", "What kind of doubt it is; docs/protocol.md has the laws.", ", ".join(KINDS)),
    _D.text("words", "What was said and why it cannot be, in words."),
    _D.number("claimed", "What the headset said, where it is a figure."),
    _D.number("possible", "The furthest that it can have been."),
    _D.text("value_unit", "The unit of both; empty for a count.", "s"),
)

ALARMS: tuple[Column, ...] = (
    *session_columns("alarms"),
    _A.text(
        "code",
        "What is wrong.",
        "silent, page_silent, too_slow, disconnected, backlog, bad_values, frozen, "
        "low_frame_rate, gap, jump, clock_unknown, clock_uncertain, storage, writer_failed, "
        "background_failed, "
        "stop_rule_met, stop_rule_near, stop_rule_unknown, help_asked, question_asked, stop_asked, "
        "feet_untracked, consent_refused, refusal_retracted, impossible, doubtful",
    ),
    _A.text("severity", "How urgent it is.", "info, warning, critical"),
    _A.text("state", "Whether it began or ended.", "raised, cleared"),
    _A.text("stream", "The stream it is about, where it is about one.", "target, actual"),
    _A.text("message", "What the operator was told; at the end, why it ended or how far it came."),
    _A.number("value", "How much: a length of time, a rate or a number of frames.", "", "0 and up"),
    _A.text("value_unit", "The unit of the value; empty for a number of frames.", "s, ms, Hz"),
    _A.number("client_t_s", "When on the client's monotonic clock, where it is about frames.", "s"),
    _A.time("at_utc", "When the server said so."),
)
