"""Small tunings for tests: of the left arm only."""

import time
from dataclasses import replace
from typing import Any

from app.protocol.avatar import file_of
from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import default_configuration
from tests.features.lab import Json, Lab, ok

PATH = "/api/avatar-tunings"
HELD = ("trunk_head", "left_leg", "right_leg", "right_arm", "left_fingers", "right_fingers")
ARM: Configuration = replace(default_configuration(), locked_groups=HELD)
"""A configuration in which only the left arm is free: eight axes."""


def as_json(configuration: Configuration) -> Json:
    """Return a configuration as it is sent in JSON."""
    body: Json = file_of(configuration).model_dump(mode="json")
    return body


def begun(lab: Lab, configuration: Configuration = ARM, **options: Any) -> Json:
    """Start a tuning of a configuration that is not saved."""
    request = {"configuration": as_json(configuration), "options": options}
    view: Json = ok(lab.operator.post(PATH, json=request))
    return view


def settled(lab: Lab, tuning_id: str) -> Json:
    """Wait until a tuning has ended, and return it."""
    for _ in range(1200):
        view: Json = ok(lab.operator.get(f"{PATH}/{tuning_id}"))
        if view["state"] != "tuning":
            return view
        time.sleep(0.05)
    raise AssertionError(f"still tuned: {view['progress']}")
