"""Make `tests/vectors/avatar/edits.json`: what the console's page computes itself of an edit.

`python -m tests.protocol.edit_vectors` writes it; `tests/vectors/avatar/README.md` describes it.
"""

import json
from collections.abc import Iterator
from pathlib import Path

from app.protocol.avatar import file_of
from app.protocol.avatar_editing import Edited, edited, read_operations
from app.science.avatar.configuration import Configuration
from tests.protocol.made_up_operations import EVERYTHING, Json, made_up_operations
from tests.science.avatar.configurations import made_up

FILE = Path(__file__).parents[1] / "vectors" / "avatar" / "edits.json"
CASES, MOST_AXES = 15, 12
_TARGETS = ["LeftUpperLeg", "LeftFoot"]


def _joint(**values: object) -> Json:
    return {"operation": "edit_joint", "targets": _TARGETS, "limits_deg": {}, **values}


def _load(**values: object) -> Json:
    return {"operation": "load", **values, "what": EVERYTHING}


CALLS: list[tuple[str, list[object], Json]] = [
    (
        "setField",
        [["LeftFootX"], "low_deg", -30],
        {"operation": "set_limits", "targets": ["LeftFootX"], "low_deg": -30},
    ),
    (
        "setField",
        [["LeftFootX"], "kp_nm_per_rad", 12.5],
        {"operation": "set_gains", "targets": ["LeftFootX"], "kp_nm_per_rad": 12.5},
    ),
    ("setJointField", [_TARGETS, "low_deg", -30], _joint(low_deg=-30)),
    ("setJointField", [_TARGETS, "high_deg", 15], _joint(high_deg=15)),
    ("setJointField", [_TARGETS, "Z", 20], _joint(limits_deg={"Z": 20})),
    ("setJointField", [_TARGETS, "kp", 99], _joint(drive={"kp_nm_per_rad": 99})),
    ("setJointField", [_TARGETS, "torque", 7], _joint(drive={"max_torque_nm": 7})),
    ("setJointField", [_TARGETS, "shared_kd", 3], _joint(shared_drive={"kd_nm_s_per_rad": 3})),
    ("mirror", ["left_to_right"], {
        "operation": "mirror", "direction": "left_to_right", "targets": ["all"], "what": EVERYTHING,
    }),
    ("resetGroup", ["left_leg"], _load(key="standard", targets=["left_leg"])),
    ("loadVersion", ["standard", 1], _load(key="standard", version=1)),
]  # fmt: skip
"""Functions of the page that make operations, their arguments, and the operation."""


def cases() -> Iterator[tuple[Configuration, list[Json], Edited]]:
    """Yield small made-up configurations with operations that can be made, and their result."""
    found = seed = 0
    while found < CASES:
        seed += 1
        before = made_up(seed)
        operations = made_up_operations(before, seed)
        if len(before.axes) > MOST_AXES:
            continue
        done = edited(before, read_operations(json.dumps(operations)), _no_version)
        # Of a group without an entry the page shows that it is stiff, the command that it has none.
        compliant = any(one.path.startswith("compliance") for one in done.changed)
        if not done.problems and not compliant:
            found += 1
            yield before, operations, done


def make() -> str:
    """Return the file's text, with a call or a case on each line."""
    calls = ",\n".join(
        json.dumps({"call": name, "arguments": arguments, "operations": [operation]})
        for name, arguments, operation in CALLS
    )
    made = ",\n".join(
        json.dumps(
            {
                "operations": operations,
                "before": _as_page(before),
                "after": _as_page(done.configuration),
                "changed": [[one.path, one.old, one.new] for one in done.changed],
            }
        )
        for before, operations, done in cases()
    )
    fact = "The page makes the operations of the command, and finds the same differences."
    return f'{{"fact": {json.dumps(fact)},\n"calls": [\n{calls}\n],\n"cases": [\n{made}\n]}}\n'


def _as_page(configuration: Configuration) -> Json:
    file: Json = file_of(configuration).model_dump(mode="json")
    return file


def _no_version(key: str, _: int | None) -> Configuration:
    raise AssertionError(key)


if __name__ == "__main__":
    FILE.write_text(make())
