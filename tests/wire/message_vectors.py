"""One JSON message of every kind, and messages that must be rejected."""

from typing import Any

Json = dict[str, Any]
BEYOND_A_DOUBLE = 2**53 + 1
"""Nanoseconds that a double cannot represent exactly; clients must return every digit."""

CONTACT: Json = {
    "kind": "contact",
    "phase_id": 2,
    "surface": "hand/2/left",
    "surface_kind": "side",
    "box": 2,
    "side": "left",
    "body_part": "RightHand",
    "begin_s": 20.25,
    "end_s": 20.75,
    "begin_active_s": 7.25,
    "end_active_s": 7.75,
    "effect": "side",
}
PHASE: Json = {
    "kind": "phase",
    "phase_id": 2,
    "what": "started",
    "t_s": 12.5,
    "active_s": 0.0,
    "cause": "headset",
}
COMPLETION: Json = {
    "kind": "completion",
    "phase_id": 2,
    "number": 1,
    "t_s": 31.5,
    "active_s": 18.5,
    "duration_s": 18.5,
    "order": [4, 3, 2, 1],
    "out_of_order_touches": 0,
}
AVATAR_CHANGED: Json = {
    "kind": "avatar_changes",
    "revision": 41,
    "t_s": 20.5,
    "applied": True,
    "problem": None,
    "held_rad": {"LeftLowerArmX": 0.125, "LeftLowerArmY": 1.5},
}
AVATAR_NOT_CHANGED: Json = {
    **AVATAR_CHANGED,
    "applied": False,
    "problem": "the model has no convex piece of LeftHand",
    "held_rad": {},
}
GOALS: Json = {
    "kind": "goals",
    "t_s": 9.5,
    "frame_seq": 0,
    "source": "controllers",
    "states": {
        "Hips": "inferred",
        "Head": "tracked",
        "LeftHand": "tracked",
        "RightHand": "lost",
        "LeftLowerLeg": "inferred",
        "RightLowerLeg": "inferred",
    },
}
CALIBRATION: Json = {
    "kind": "calibration",
    "t_s": 8.25,
    "revision": None,
    "cause": "first",
    "stature_m": 1.72,
    "span_m": 1.75,
    "eye_height_m": 1.61,
    "tracker_from_goal": {
        "Head": {"position_m": [0.0, -0.09, 0.08], "rotation": [1.0, 0.0, 0.0, 0.0]}
    },
    "residuals_m": {"LeftHand": 0.012, "RightHand": 0.008},
    "sources": {"Head": "viewer", "LeftHand": "controller", "RightHand": "controller"},
    "notices": ["bent_knees"],
}
CALIBRATION_STEP: Json = {
    "kind": "calibration_step",
    "t_s": 6.5,
    "step": "t_pose",
    "number": 3,
    "total": 6,
    "problem": "bent_elbows",
}
ADDED_LATENCY: Json = {
    "kind": "added_latency",
    "phase_id": 2,
    "t_s": 12.5,
    "added_s": 0.0111,
    "compensated_s": 0.0,
    "runs_in": "worker",
}
CALL: Json = {"kind": "call", "t_s": 30.0, "what": "stop"}
PROBED: Json = {
    "type": "probed",
    "client_sent_s": 3.0,
    "server_received_ns": BEYOND_A_DOUBLE,
    "server_sent_ns": BEYOND_A_DOUBLE + 1000,
    "client_received_s": 3.0015,
}
TIMED_OUT: Json = {**PROBED, **dict.fromkeys(list(PROBED)[2:])}
PRODUCED: Json = {
    "type": "produced",
    "epoch": 1,
    "streams": {"target": 540, "actual": 540, "reports": 3},
}


def report(body: Json) -> Json:
    """Return a report with this body."""
    return {"type": "report", "epoch": 1, "seq": 0, "body": body}


FROM_CLIENT: list[tuple[str, Json]] = [
    (
        "hello_of_a_new_run",
        {"type": "hello", "protocol": 1, "client": "Käthe's client 0.3", "epoch": None},
    ),
    ("hello_again", {"type": "hello", "protocol": 1, "client": "my client 0.3", "epoch": 7}),
    (
        "hello_of_one_that_simulates",
        {
            "type": "hello",
            "protocol": 1,
            "client": "my client 0.4",
            "epoch": None,
            "avatars": ["delayed_copy", "physics"],
        },
    ),
    (
        "hello_of_one_that_sends_fingers",
        {
            "type": "hello",
            "protocol": 1,
            "client": "my client 0.5",
            "epoch": None,
            "fingers": True,
        },
    ),
    (
        "produced_with_fingers",
        {
            **PRODUCED,
            "streams": {**PRODUCED["streams"], "target_fingers": 540, "actual_fingers": 534},
        },
    ),
    (
        "hello_of_one_that_changes_its_avatar",
        {
            "type": "hello",
            "protocol": 1,
            "client": "my client 0.5",
            "epoch": None,
            "avatars": ["physics"],
            "changes_avatar": True,
        },
    ),
    (
        "hello_of_one_that_runs_the_whole_study",
        {
            "type": "hello",
            "protocol": 1,
            "client": "my client 0.6",
            "epoch": None,
            "avatars": ["physics", "delayed_copy"],
            "goals": True,
            "panels": True,
            "calibrates": True,
        },
    ),
    ("goals", report(GOALS)),
    ("calibration", report(CALIBRATION)),
    (
        "calibration_as_ordered",
        report({**CALIBRATION, "cause": "order", "revision": 41, "span_m": None}),
    ),
    (
        "calibration_with_measured_arms",
        report({**CALIBRATION, "segments_m": {"upper_arm": 0.28, "forearm": 0.22}}),
    ),
    ("calibration_step", report(CALIBRATION_STEP)),
    ("calibration_step_without_a_problem", report({**CALIBRATION_STEP, "problem": None})),
    ("added_latency", report(ADDED_LATENCY)),
    ("call_to_stop", report(CALL)),
    ("call_for_help", report({**CALL, "what": "help"})),
    ("avatar_changes", report(AVATAR_CHANGED)),
    ("avatar_changes_that_failed", report(AVATAR_NOT_CHANGED)),
    ("materialised", report({"kind": "materialised", "t_s": 10.125})),
    ("phase_started", report(PHASE)),
    ("phase_paused", report({**PHASE, "what": "paused", "cause": "disconnected"})),
    ("contact_with_a_side", report(CONTACT)),
    (
        "contact_with_the_target",
        report(
            {
                **CONTACT,
                "surface": "hand/target",
                "surface_kind": "target",
                "box": None,
                "side": None,
                "effect": "completed",
            }
        ),
    ),
    ("completion", report(COMPLETION)),
    ("last_report_there_can_be", {**report(PHASE), "seq": 2**53 - 1, "epoch": 2**31 - 1}),
    ("probe", {"type": "probe", "client_sent_s": 3.0}),
    ("probed", PROBED),
    ("probed_in_vain", TIMED_OUT),
    ("produced", PRODUCED),
    ("produced_of_one_stream", {**PRODUCED, "streams": {"reports": 4}}),
]

STATE: Json = {
    "type": "state",
    "version": 12,
    "status": "active",
    "step_index": 6,
    "step_kind": "task",
    "materialised": True,
    "recording": True,
    "phase": {
        "phase_id": 2,
        "kind": "task",
        "limb": "hand",
        "status": "running",
        "latency_ms": 125.0,
        "preparation_s": 5.0,
        "duration_s": 60.0,
        "freeze_s": 5.0,
        "active_s": 12.5,
        "completions": 1,
        "pausing": False,
        "resuming": False,
        "until_completions": None,
    },
    "participant": {"handedness": "right", "footedness": "both", "stature_m": 1.72},
}
STATE_BEFORE: Json = {
    **STATE,
    "status": "planned",
    "step_index": None,
    "step_kind": None,
    "materialised": False,
    "recording": False,
    "phase": None,
    "participant": {"handedness": None, "footedness": None, "stature_m": None},
}
STATE_OF_PRACTICE: Json = {
    **STATE,
    "step_index": 5,
    "step_kind": "practice",
    "phase": {**STATE["phase"], "kind": "practice", "latency_ms": 0.0, "until_completions": 2},
}
STATE_OF_A_CHANGED_AVATAR: Json = {
    **STATE,
    "avatar_changes": {
        "revision": 41,
        "gravity": False,
        "self_collision": None,
        "colliders": {"LeftHand": "none"},
        "layers": [{"layers": ["left_hand", "torso"], "collide": False}],
        "held_rad": {"LeftLowerArmX": None, "LeftLowerArmY": 1.5},
        "motors": {
            "HeadX": {"kp_nm_per_rad": 40.5, "kd_nm_s_per_rad": 1.25, "max_torque_nm": 30.0}
        },
    },
}
STATE_WITH_A_FORM: Json = {
    **STATE,
    "step_index": 7,
    "step_kind": "questionnaire",
    "phase": None,
    "panel": {
        "language": "de",
        "title": "Fragebogen",
        "text": None,
        "form": "block1.hand.karas2020#1",
        "answer": "headset",
        "acknowledge": False,
        "headset_off": False,
        "held": False,
        "called": False,
    },
}
STATE_BEFORE_A_FOOT_TASK: Json = {
    **STATE_WITH_A_FORM,
    "step_kind": "task",
    "panel": {**STATE_WITH_A_FORM["panel"], "form": None, "answer": None, "limb": "foot"}
    | {"screen_texts": {"freeze": "Bitte halten Sie einige Sekunden still."}},
}
STATE_AFTER_A_SHIFT: Json = {
    **STATE,
    "calibration": {
        "revision": 41,
        "calibrate": False,
        "shifts_m": {"LeftHand": [0.01, 0.0, -0.02]},
    },
}
STATE_OF_ANOTHER_BODY: Json = {**STATE, "phase": {**STATE["phase"], "body": "robot"}}
POSITIONS: list[Json] = [
    {"stream": "target", "epoch": 1, "next_seq": 540},
    {"stream": "reports", "epoch": 1, "next_seq": 3},
]
WELCOME: Json = {
    "type": "welcome",
    "protocol": 1,
    "session_id": "0f8c",
    "epoch": 2,
    "time_scale": 1.0,
    "language": "de",
    "avatar": "delayed_copy",
    "on_disconnect": "pause",
    "undelayed_parts": ["Hips"],
    "tasks": {"hand": {"boxes": []}, "foot": {}},
    "texts": {"t_pose": "Bitte die Arme ausstrecken."},
    "positions": POSITIONS,
    "state": STATE_BEFORE,
}
FLAG: Json = {
    "type": "flag",
    "code": "non_unit",
    "stream": "actual",
    "epoch": 1,
    "seq": 7,
    "frames": 1,
    "message": "1 frame(s) hold a rotation that is not of unit length",
}
REFUSED: Json = {
    "type": "refused",
    "epoch": 1,
    "seq": 2,
    "message": "phase 2 is not running",
    "remedy": "Follow the newest state.",
}
ANSWER: Json = {
    "type": "probe",
    "client_sent_s": 3.0,
    "server_received_ns": BEYOND_A_DOUBLE,
    "server_sent_ns": BEYOND_A_DOUBLE + 1000,
}

FROM_SERVER: list[tuple[str, Json]] = [
    ("welcome", WELCOME),
    ("state", STATE),
    ("state_of_a_practice", STATE_OF_PRACTICE),
    ("state_of_a_changed_avatar", STATE_OF_A_CHANGED_AVATAR),
    ("state_with_a_form_in_the_headset", STATE_WITH_A_FORM),
    ("state_before_a_foot_task", STATE_BEFORE_A_FOOT_TASK),
    ("state_after_a_tracker_was_shifted", STATE_AFTER_A_SHIFT),
    ("state_of_another_body", STATE_OF_ANOTHER_BODY),
    ("welcome_to_a_study_with_bodies", {**WELCOME, "bodies": ["robot"]}),
    ("state_before_the_start", STATE_BEFORE),
    ("ack", {"type": "ack", "positions": POSITIONS}),
    ("resend", {"type": "resend", **POSITIONS[0]}),
    ("flag", FLAG),
    ("refused", REFUSED),
    (
        "error",
        {
            "type": "error",
            "code": "not_signed_in",
            "message": "this headset is not paired",
            "remedy": "Pair it again.",
        },
    ),
    ("answer_to_a_probe", ANSWER),
]

REFUSED_CLIENT: list[tuple[str, Json]] = [
    ("unknown_type", {"type": "hallo", "protocol": 1, "client": "x", "epoch": None}),
    ("unknown_field", {**PRODUCED, "surprise": 1}),
    ("hello_with_epoch_zero", {"type": "hello", "protocol": 1, "client": "x", "epoch": 0}),
    ("hello_with_an_epoch_of_true", {"type": "hello", "protocol": 1, "client": "x", "epoch": True}),
    ("hello_with_an_epoch_in_words", {"type": "hello", "protocol": 1, "client": "x", "epoch": "1"}),
    ("hello_with_a_protocol_of_true", {"type": "hello", "protocol": True, "client": "x"}),
    ("hello_with_one_for_yes", {"type": "hello", "protocol": 1, "client": "x", "fingers": 1}),
    ("hello_without_protocol", {"type": "hello", "client": "x", "epoch": None}),
    (
        "hello_with_too_many_avatars",
        {"type": "hello", "protocol": 1, "client": "x", "epoch": None, "avatars": ["y"] * 11},
    ),
    ("held_angle_is_beyond_range", report({**AVATAR_CHANGED, "held_rad": {"HeadX": 7.5}})),
    ("revision_is_negative", report({**AVATAR_CHANGED, "revision": -1})),
    ("goals_without_the_hips", report({**GOALS, "states": {"Head": "tracked"}})),
    ("unknown_state_of_a_goal", report({**GOALS, "states": {**GOALS["states"], "Head": "seen"}})),
    ("unknown_goal", report({**GOALS, "states": {**GOALS["states"], "Tail": "tracked"}})),
    ("stature_is_negative", report({**CALIBRATION, "stature_m": -1.7})),
    ("stature_of_nobody", report({**CALIBRATION, "stature_m": 0.0})),
    ("stature_of_a_giant", report({**CALIBRATION, "stature_m": 10.0})),
    ("residual_of_an_unknown_goal", report({**CALIBRATION, "residuals_m": {"Tail": 0.1}})),
    ("compensated_more_than_added", report({**ADDED_LATENCY, "compensated_s": 0.5})),
    ("unknown_call", report({**CALL, "what": "pizza"})),
    ("time_is_null", report({"kind": "materialised", "t_s": None})),
    ("time_is_true", report({"kind": "materialised", "t_s": True})),
    ("time_is_negative", report({**CONTACT, "end_s": -1.0})),
    ("time_is_beyond_range", report({**PHASE, "t_s": 1.0e9 + 1.0})),
    ("phase_id_is_negative", report({**CONTACT, "phase_id": -1})),
    ("phase_id_is_beyond_range", report({**CONTACT, "phase_id": 2**31})),
    ("phase_id_is_true", report({**CONTACT, "phase_id": True})),
    ("phase_id_is_not_whole", report({**CONTACT, "phase_id": 1.5})),
    ("unknown_arrow", report({**PHASE, "what": "stopped"})),
    ("unknown_surface_kind", report({**CONTACT, "surface_kind": "ceiling"})),
    ("surface_is_too_long", report({**CONTACT, "surface": "x" * 41})),
    ("name_with_nul", report({**CONTACT, "body_part": "Right\0Hand"})),
    ("completion_number_zero", report({**COMPLETION, "number": 0})),
    ("completion_number_is_true", report({**COMPLETION, "number": True})),
    ("order_is_too_long", report({**COMPLETION, "order": [1] * 17})),
    ("seq_is_beyond_range", {**report(PHASE), "seq": 2**53}),
    ("seq_is_false", {**report(PHASE), "seq": False}),
    ("epoch_is_zero", {**report(PHASE), "epoch": 0}),
    ("probed_by_half", {**PROBED, "client_received_s": None}),
    ("produced_of_an_unknown_stream", {**PRODUCED, "streams": {"thoughts": 1}}),
    ("produced_is_negative", {**PRODUCED, "streams": {"target": -1}}),
]
REFUSED_SERVER: list[tuple[str, Json]] = [
    ("welcome_without_positions", {k: v for k, v in WELCOME.items() if k != "positions"}),
    ("welcome_without_an_epoch", {**WELCOME, "epoch": None}),
    ("ack_without_a_stream", {"type": "ack", "positions": [{"epoch": 1, "next_seq": 5}]}),
    ("ack_in_words", {"type": "ack", "positions": "all"}),
    ("state_without_a_phase", {k: v for k, v in STATE.items() if k != "phase"}),
    ("unknown_flag", {**FLAG, "code": "ugly"}),
    ("error_without_words", {"type": "error", "code": "invalid"}),
]
