"""Tests that a configuration's avatar model is deterministic and has the right settings."""

from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

from app.science.avatar.body.body import BodyError
from app.science.avatar.body.parts import AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration.editing import with_axis, without_parts
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.mjcf.model import avatar_model

SHIPPED = default_configuration()


def root_of(mjcf: str) -> ET.Element:
    """Return the root element of a model's MJCF."""
    return ET.fromstring(mjcf)  # noqa: S314 - our own text


def test_the_same_configuration_gives_the_same_bytes() -> None:
    """The same configuration always gives the same MJCF, so its hash identifies the model."""
    first, second = (avatar_model(SHIPPED, 1.75) for _ in range(2))
    assert first.mjcf == second.mjcf
    assert len(first.content_hash) == 64
    assert first.content_hash == second.content_hash
    assert avatar_model(SHIPPED, 1.76).content_hash != first.content_hash


def test_gains_and_limits_are_the_configurations() -> None:
    """Every free axis has the configuration's gains and limits; a locked one has no motor."""
    stiff = replace(SHIPPED.axes["HeadX"], kp=321.0, kd=12.0, max_torque_nm=34.0)
    body = with_axis(SHIPPED, "HeadX", stiff)
    motors = {one.get("name"): one for one in root_of(avatar_model(body, 1.75).mjcf).iter("pid")}
    assert set(motors) == set(AXIS_NAMES) - SHIPPED.locked_axes
    head = motors["HeadX"]
    assert (head.get("kp"), head.get("kv"), head.get("forcerange")) == ("321", "12", "-34 34")
    limits = [float(value) for value in str(head.get("posrange")).split()]
    assert limits == pytest.approx([stiff.low_rad, stiff.high_rad], abs=1e-12)


def test_switches_reach_the_model() -> None:
    """The model has the configuration's gravity, hips and mass."""
    light = replace(SHIPPED, gravity=False, hips="welded", total_mass_kg=50.0)
    model = avatar_model(light, 1.75)
    root = root_of(model.mjcf)
    option = root.find("option")
    assert option is not None
    assert str(option.get("gravity")).split()[1] == "0"
    assert root.find("equality/weld") is not None
    assert sum(one.mass_kg for one in model.masses.parts.values()) == pytest.approx(50.0)


def test_four_fingers_are_enough() -> None:
    """The model omits parts that the configuration lacks; a missing required part is reported."""
    little = frozenset(part for part in PART_NAMES if "Little" in part)
    model = avatar_model(without_parts(SHIPPED, little), 1.75)
    assert set(model.body.parts) == set(PART_NAMES) - little
    with pytest.raises(BodyError, match="LeftFoot"):
        avatar_model(without_parts(SHIPPED, frozenset({"LeftFoot"})), 1.75)
