"""A report of a good headset, and changes of it."""

import copy
import secrets
from typing import Any

from app.features.record.self_tests.schemas import SelfTestReport
from tests.features.lab import Json

GOALS = ("Hips", "Head", "LeftHand", "RightHand", "LeftLowerLeg", "RightLowerLeg")
TRACKED: Json = {
    "tracked": 1.0,
    "inferred": 0.0,
    "lost": 0.0,
    "longest_loss_s": 0.0,
    "pose_rate_hz": 90.0,
}
GOOD: Json = {
    "id": "0" * 32,
    "started_at": "2026-03-02T09:00:00Z",
    "duration_s": 120.0,
    "device": {
        "user_agent": "Mozilla/5.0 (X11; Linux x86_64; Quest 3) OculusBrowser/41.0",
        "name": "Quest 3",
        "inputs": ["hands"],
    },
    "rendering": {
        "mode": "immersive",
        "nominal_rate_hz": 90.0,
        "frames": 10_790,
        "mean_rate_hz": 89.92,
        "interval_p50_s": 0.0111,
        "interval_p95_s": 0.0113,
        "interval_p99_s": 0.0124,
        "interval_longest_s": 0.0445,
        "late_frames": 9,
    },
    "physics": {
        "model_hash": "a" * 64,
        "stature_m": 1.75,
        "where": "worker",
        "simulated_s": 119.9,
        "real_time_factor": 3.4,
        "frame_p50_s": 0.0028,
        "frame_p95_s": 0.0051,
        "frame_p99_s": 0.0073,
        "resets": 0,
    },
    "tracking": dict.fromkeys(GOALS, TRACKED),
    "storage": {
        "batches": 2400,
        "bytes": 8_200_000,
        "acknowledged": 2400,
        "round_trip_p50_s": 0.061,
        "round_trip_p95_s": 0.104,
        "round_trip_longest_s": 0.42,
        "bytes_per_s": 68_300.0,
        "journal_writes": 460,
        "journal_write_p95_s": 0.004,
    },
    "page": {"memory_bytes": 210_000_000, "errors": []},
}
"""The report of a headset of which every verdict is ok."""


def report(**changes: Any) -> Json:
    """Return the good report with a new id; `a__b=1` changes the field b of the part a."""
    changed = copy.deepcopy(GOOD)
    changed["id"] = secrets.token_hex(16)
    for path, value in changes.items():
        *parts, last = path.split("__")
        place = changed
        for part in parts:
            place = place[part]
        place[last] = value
    return changed


def parsed(**changes: Any) -> SelfTestReport:
    """Return the changed report as the server reads it."""
    return SelfTestReport.model_validate(report(**changes))
