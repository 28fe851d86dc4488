"""Tests of the settings that most configurations leave out: layers, own delays, relative masses."""

from dataclasses import replace
from math import fsum

import mujoco
import pytest

from app.protocol.avatar import content_of, load_avatar, loaded
from app.science.avatar.body import COLLIDING, PART_NAMES, body_masses, build_body
from app.science.avatar.configuration import (
    AvatarSettingsError,
    as_configured,
    with_delays,
    with_layers,
)
from app.science.avatar.mjcf import avatar_model, default_configuration
from app.science.avatar.simulation import PhysicsAvatar
from tests.science.avatar.configurations import whole_body

STANDARD = default_configuration()


def test_a_configuration_without_them_is_as_before() -> None:
    """What is left out is not written, so hashes and models of older configurations stay."""
    assert not {"layers", "delays_ms", "relative_masses_percent"} & set(content_of(STANDARD))
    undone = with_layers(
        with_layers(STANDARD, ("torso", "left_hand"), collide=False),
        ("left_hand", "torso"),
        collide=True,
    )
    undone = with_delays(with_delays(undone, ["all"], 0.1), ["all"], 0.0)
    assert loaded(undone) == loaded(STANDARD)


def test_layers_of_a_configuration_are_built_and_in_force() -> None:
    """A pair of layers that is switched off in the configuration does not touch in the model."""
    apart = with_layers(STANDARD, ("left_hand", "torso"), collide=False)
    body = PhysicsAvatar(avatar_model(apart, 1.75).mjcf)
    built = body.model
    usual = PhysicsAvatar(avatar_model(STANDARD, 1.75).mjcf).model

    def touch(model: mujoco.MjModel, first: str, second: str) -> bool:
        a, b = (model.geom(f"{part}/0") for part in (first, second))
        return bool(a.contype & b.conaffinity) or bool(b.contype & a.conaffinity)

    assert touch(usual, "LeftHand", "Spine")
    assert not touch(built, "LeftHand", "Spine")
    assert touch(built, "RightHand", "Spine")
    body.switches.set_self_collision(on=False)
    assert not touch(built, "RightHand", "Spine")
    body.switches.set_self_collision(on=True)
    assert not touch(built, "LeftHand", "Spine")
    assert touch(built, "RightHand", "Spine")
    assert as_configured(apart).layers == COLLIDING - {frozenset(("left_hand", "torso"))}


def test_a_part_with_an_own_delay_lags_behind_the_others() -> None:
    """Delays of single parts are added to the latency, and leave room for as much of it."""
    late = with_delays(STANDARD, ["left_arm"], 0.2)
    body = PhysicsAvatar(avatar_model(late, 1.75, longest_delay_s=0.5).mjcf)
    switches, delays = body.switches, body.model.actuator_delay
    left, right = (body.model.actuator(f"{side}HandZ").id for side in ("Left", "Right"))
    assert (delays[left], delays[right], switches.delay_s) == (0.2, 0.0, 0.0)
    assert switches.longest_delay_s == pytest.approx(0.5)
    switches.set_delay(0.5)
    assert (delays[left], delays[right]) == pytest.approx((0.7, 0.5))
    assert switches.delay_s == pytest.approx(0.5)
    switches.set_delay(0.0)
    assert (delays[left], delays[right]) == (0.2, 0.0)


def test_relative_masses_keep_the_mass_of_the_body() -> None:
    """Parts with a given share have it, and the others keep their proportions."""
    body = build_body(1.75)
    usual = body_masses(body, 72.0).parts
    heavy = body_masses(body, 72.0, relative={"LeftHand": 0.1, "Head": 0.2})
    assert heavy.total_kg == pytest.approx(72.0)
    assert heavy.parts["LeftHand"].mass_kg == pytest.approx(7.2)
    assert heavy.parts["Head"].mass_kg == pytest.approx(14.4)
    ratios = {
        heavy.parts[part].mass_kg / usual[part].mass_kg
        for part in PART_NAMES
        if part not in ("LeftHand", "Head")
    }
    assert max(ratios) == pytest.approx(min(ratios))
    equal = body_masses(body, 52.0, relative=dict.fromkeys(PART_NAMES, 1.0 / 52.0)).parts
    assert [one.mass_kg for one in equal.values()] == pytest.approx([1.0] * 52)
    assert fsum(one.mass_kg for one in equal.values()) == pytest.approx(52.0)


def test_impossible_values_are_refused() -> None:
    """Pairs that overlap, delays and shares out of range are refused with what is valid."""
    for values, path in (
        ({"colliding": COLLIDING | {frozenset(("torso", "left_leg"))}}, "layers"),
        ({"delays_s": {"LeftHand": 1.5}}, "delays_ms.LeftHand"),
        ({"delays_s": {"Tail": 0.1}}, "delays_ms.Tail"),
        ({"relative_masses": {"Head": 0.0}}, "relative_masses_percent.Head"),
        ({"relative_masses": {"Head": 0.6, "Neck": 0.4}}, "relative_masses_percent"),
        ({"relative_masses": dict.fromkeys(PART_NAMES, 0.01)}, "relative_masses_percent"),
    ):
        with pytest.raises(AvatarSettingsError) as caught:
            replace(whole_body(), **values)
        (problem,) = caught.value.problems
        assert problem.path == path
        assert problem.valid
        assert problem.remedy


def test_a_file_may_name_the_layers_of_a_pair_in_any_order() -> None:
    """Order, and entries that change nothing, do not affect the hash."""
    text = loaded(with_layers(STANDARD, ("left_hand", "torso"), collide=False))
    swapped = text.canonical_json.replace(
        '{"collide":false,"layers":["torso","left_hand"]}',
        '{"collide":true,"layers":["left_foot","right_foot"]},'
        '{"collide":false,"layers":["left_hand","torso"]}',
    )
    assert swapped != text.canonical_json
    assert load_avatar(swapped).content_hash == text.content_hash
