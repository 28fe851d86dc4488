"""The tables of the database, grouped by their content in people's terms.

A table of a later migration has to be added here; a test checks that.
"""

from typing import Literal

Family = Literal["samples", "results", "answers", "events", "captures", "setup"]

FAMILIES: dict[Family, tuple[str, ...]] = {
    # Movement, as the headset sent it.
    "samples": (
        "telemetry_batches",
        "telemetry_chunks",
        "telemetry_streams",
        "client_reports",
        "clock_probes",
        "road_chunks",
        "tracker_alignments",
        "tracker_chunks",
    ),
    # Results computed from it, phase by phase.
    "results": (
        "completions",
        "contacts",
        "joint_error_courses",
        "joint_errors",
        "phase_latencies",
        "phase_quality",
        "phases",
        "road_crossings",
        "road_runs",
    ),
    "answers": (
        "answer_corrections",
        "answer_imports",
        "answers",
        "imported_forms",
        "scores",
        "submissions",
    ),
    # The record of each session, and that of the lab.
    "events": (
        "alarms",
        "audit_entries",
        "audit_head",
        "session_contents",
        "session_events",
        "sessions",
    ),
    "captures": (
        "capture_contents",
        "capture_pieces",
        "captures",
        "humanoids",
        "joint_maps",
        "walk_sets",
        "walking_models",
        "walking_scenes",
    ),
    "setup": (
        "accounts",
        "alembic_version",
        "avatar_tunings",
        "avatar_versions",
        "avatars",
        "calibrations",
        "copies_made",
        "devices",
        "erasures",
        "headset_test_batches",
        "headset_tests",
        "instrument_versions",
        "invitations",
        "ledger_slots",
        "ledgers",
        "live_doors",
        "live_limbs",
        "login_tokens",
        "pairing_codes",
        "participants",
        "pilots",
        "slot_attempts",
        "studies",
        "study_members",
        "study_versions",
        "suggestions",
    ),
}
FAMILY_OF: dict[str, Family] = {
    table: family for family, tables in FAMILIES.items() for table in tables
}
