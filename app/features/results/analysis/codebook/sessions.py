"""The columns of sessions.csv, phases.csv and events.csv."""

from dataclasses import replace

from app.features.results.analysis.codebook.column import (
    Column,
    Describe,
    phase_columns,
    session_columns,
)

_S = Describe("sessions")
_P = Describe("phases")
_E = Describe("events")

SESSIONS: tuple[Column, ...] = (
    *session_columns("sessions"),
    _S.valid(
        "False if the session was aborted or withdrawn, was completed without what the study's "
        "valid_when asks for, if its data were erased, or if its headset said what cannot be true "
        "of more than one phase (doubts.csv). A session that still runs is not judged yet.",
        "False if the session was aborted or withdrawn, if its data were erased, or if its headset "
        "said what cannot be true of more than one phase (doubts.csv).",
    ),
    replace(
        _S.text(
            "reasons_not_valid",
            "What a completed session lacks of the study's valid_when, separated by semicolons; or "
            "that it was aborted or withdrawn. Empty if it is valid.",
        ),
        of_rules=True,
    ),
    _S.text("status", "Where it stands.", "planned, active, completed, aborted, withdrawn"),
    _S.text("language", "Language of the participant's texts.", "ISO 639-1 code"),
    _S.text(
        "order",
        "Added latencies in the order of the blocks, ms, separated by spaces; if conditions of the "
        "study share latencies, the keys of the conditions instead.",
    ),
    _S.integer("slot_index", "Row of the counterbalancing ledger.", levels="0 and up"),
    _S.integer(
        "slot_block", "Block of the ledger: each holds every order once.", levels="0 and up"
    ),
    _S.integer("slot_replicate", "Which repetition of the order it is.", levels="1 and up"),
    _S.number(
        "time_scale", "Seconds of the client's clock per real second.", "s/s", "1 for people"
    ),
    _S.number("height_stated_m", "Height as the participant stated it.", "m", "0.8 to 2.5"),
    _S.number("height_matched_m", "Height that the avatar was matched to.", "m", "0.8 to 2.5"),
    _S.boolean(
        "consent_given",
        "Whether every consent of the study was given; empty where it has none. Names and "
        "signatures are in no export.",
    ),
    _S.time("consent_at_utc", "When the last of them was given."),
    _S.text("study_content_hash", "SHA-256 of the study version's content."),
    _S.text(
        "avatar_configuration_hash",
        "SHA-256 of the avatar's configuration: gains, limits, masses, locked groups; empty where "
        "it has none.",
    ),
    _S.time("created_at_utc", "When the session joined the study."),
    _S.time("started_at_utc", "When it was started."),
    _S.time("ended_at_utc", "When it was completed, aborted or withdrawn."),
)

PHASES: tuple[Column, ...] = (
    *session_columns("phases"),
    *phase_columns("phases"),
    _P.integer("step_index", "Step of the procedure.", levels="0 and up"),
    _P.text("step_key", "Name of the step in the procedure."),
    _P.text(
        "body",
        "Body that the condition prescribes, by the name that it was given in the lab; empty if "
        "the participant wore the body of the avatar's configuration.",
    ),
    _P.text(
        "status",
        "How far the phase came.",
        "preparing, running, paused, walk_back, freezing, done, voided",
    ),
    _P.text(
        "avatar_changes",
        "Who had changed settings of the avatar (gravity, collisions, casts, gains) in this phase. "
        "A change by the operator is not part of the protocol. Empty if nothing was changed. "
        "The events avatar_changed say what was changed.",
        "study, operator, study and operator",
    ),
    _P.number("active_s", "Active time: pauses and walk-backs do not count.", "s", "0 and up"),
    _P.integer("paused_count", "How often it was paused.", levels="0 and up"),
    _P.integer("walk_back_count", "How often the participant walked back.", levels="0 and up"),
    _P.integer(
        "completions",
        "Completed tasks; empty once the participant's data were erased.",
        levels="0 and up",
    ),
    _P.integer(
        "side_contacts",
        "How often a side of a box turned red; empty once the data were erased.",
        levels="0 and up",
    ),
    _P.number(
        "side_red_s",
        "Time that sides of boxes were red: for each side the union over the body parts that "
        "touched it, then the sum over sides. Two red sides at once count twice.",
        "s, active time",
        "0 and up",
    ),
    _P.number(
        "achieved_latency_ms",
        "Latency that the avatar really had: the lag at which its joints (without the hips) follow "
        "the participant's best, from the recorded frames. Empty below 5 s of movement, or where "
        "latency_reason says so. A body that follows with physics adds its own lag.",
        "ms",
    ),
    _P.number("achieved_latency_low_ms", "Lower end of its 95 % confidence interval.", "ms"),
    _P.number("achieved_latency_high_ms", "Upper end of its 95 % confidence interval.", "ms"),
    _P.boolean(
        "latency_off",
        "Whether the achieved latency is off the ordered one by more than 10 ms and more than one "
        "frame. Empty where there is none.",
    ),
    _P.text("latency_reason", "Why there is no achieved latency, or what to keep in mind of it."),
    _P.number(
        "headset_added_ms",
        "Delay that the headset's own computing adds to what is shown, as it reported: one frame "
        "if the physics runs in a worker. The achieved latency includes it. Empty if the headset's "
        "program does not say.",
        "ms",
        "0 to 1000",
    ),
    _P.number(
        "headset_compensated_ms",
        "How much of headset_added_ms was taken off the ordered delay; at 0 ms nothing can be. "
        "Expected is latency_ms + headset_added_ms - headset_compensated_ms.",
        "ms",
        "0 to 1000",
    ),
    _P.number(
        "movement_s",
        "Active time during which at least one of the participant's joints (without the hips) "
        "turned faster than 20 deg/s. Empty until it is computed.",
        "s, active time",
        "0 and up",
    ),
    _P.integer(
        "latency_samples", "Active frames of the avatar that it rests on.", levels="0 and up"
    ),
    _P.number("client_started_s", "Start of the phase on the client's monotonic clock.", "s"),
    _P.number("client_ended_s", "Freeze of the phase on the client's monotonic clock.", "s"),
    _P.time("prepared_at_utc", "When the phase was called."),
    _P.time("started_at_utc", "When the server heard that its clock ran."),
    _P.time("ended_at_utc", "When it was over."),
)

EVENTS: tuple[Column, ...] = (
    *session_columns("events"),
    _E.integer("seq", "Place in the session's log.", levels="1 and up"),
    _E.text("type", "What happened."),
    _E.text(
        "actor",
        "Who caused it: an account, a script that the server ran for one, a device or the system.",
    ),
    _E.time("recorded_at_utc", "When it was recorded."),
    _E.number("monotonic_s", "The server's monotonic clock, for durations between events.", "s"),
    _E.integer("phase_id", "The phase it is about.", levels="1 and up"),
    _E.integer("step_index", "The step it is about.", levels="0 and up"),
    _E.text("payload", "The event as canonical JSON; it holds no answers and no personal text."),
    _E.text("previous_hash", "Hash of the event before."),
    _E.text("hash", "SHA-256 over the previous hash and this event: the chain of the log."),
)
