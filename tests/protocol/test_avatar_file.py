"""Tests of the file of an avatar's configuration: lossless, hashed, with located problems."""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import given, settings

from app.protocol import ConfigError
from app.protocol.avatar import avatar_text, load_avatar, loaded, parse_avatar_json
from app.science.avatar.configuration import AxisSettings, Configuration, lock, with_axis
from tests.science.avatar.configurations import configurations, whole_body

BODY = lock(whole_body(), "head", {"HeadX": math.radians(10.0)})
TEXT = avatar_text(BODY)


@settings(max_examples=40, deadline=None)
@given(configurations())
def test_a_file_gives_back_what_was_saved(configuration: Configuration) -> None:
    """A configuration is restored exactly from its file and from its canonical form."""
    content = loaded(configuration)
    read = load_avatar(avatar_text(configuration))
    assert read == content
    assert parse_avatar_json(content.canonical_json) == configuration


def test_how_it_is_written_makes_no_difference_to_the_hash() -> None:
    """The order of keys, white space, and 72 for 72.0 do not change an avatar file's hash."""
    tree = json.loads(TEXT)
    turned = {key: tree[key] for key in reversed(tree)}
    turned["axes"] = {name: tree["axes"][name] for name in reversed(tree["axes"])}
    turned["total_mass_kg"] = 72
    hashes = {
        load_avatar(text).content_hash
        for text in (
            TEXT,
            json.dumps(turned),
            json.dumps(turned, separators=(",", ":")),
            json.dumps(tree, indent="\t"),
        )
    }
    assert len(hashes) == 1


def test_every_setting_is_in_the_hash() -> None:
    """Any change of a setting changes the hash of the avatar's configuration."""
    some = AxisSettings(1.0, 1.0, 1.0, -0.1, 0.1)
    changed = [
        with_axis(BODY, "NeckX", some),
        replace(BODY, total_mass_kg=71.0),
        replace(BODY, population="female"),
        replace(BODY, gravity=False),
        replace(BODY, self_collision=False),
        replace(BODY, hips="welded"),
        replace(BODY, target_space="world"),
        replace(BODY, colliders="none"),
        replace(BODY, part_colliders={"Head": "mesh"}),
        replace(BODY, held_rad={}),
        replace(BODY, locked_groups=("head", "left_fingers")),
        *(with_axis(BODY, "NeckX", replace(some, kp=2.0)), with_axis(BODY, "NeckY", some)),
    ]
    assert len({loaded(one).content_hash for one in [BODY, *changed]}) == len(changed) + 1


def test_the_hash_of_a_content_stays() -> None:
    """A configuration has the same hash in every release, since data refer to it."""
    one = Configuration({"LeftToesX": AxisSettings(10.0, 1.0, 5.0, -0.5, 0.5)})
    assert loaded(one).canonical_json == (
        '{"axes":{"LeftToesX":{"high_deg":28.647889757,"kd_nm_s_per_rad":1.0,'
        '"kp_nm_per_rad":10.0,"low_deg":-28.647889757,"max_torque_nm":5.0}},'
        '"colliders":"simple","format":"reembody-avatar","gravity":true,"held_deg":{},'
        '"hips":"carried","locked_groups":[],"part_colliders":{},"population":"average",'
        '"self_collision":true,"target_space":"local","total_mass_kg":72.0,"version":1}'
    )


def test_a_file_states_its_units_and_its_format() -> None:
    """A configuration file has one axis per line, angles in degrees, and units in its keys."""
    line = next(line for line in TEXT.splitlines() if "LeftUpperLegX" in line)
    assert line.strip() == (
        '"LeftUpperLegX": {"kp_nm_per_rad": 300.0, "kd_nm_s_per_rad": 20.0, '
        '"max_torque_nm": 150.0, "low_deg": -41.0, "high_deg": 125.0},'
    )
    assert TEXT.startswith('{\n  "format": "reembody-avatar",\n  "version": 1,\n')
    assert avatar_text(BODY) == TEXT


@pytest.mark.parametrize(
    ("change", "path", "expected_message", "valid"),
    [
        (('"hips": "carried"', '"hips": "loose"'), "hips", "'loose'", ""),
        (('"gravity": true', '"gravity": 1'), "gravity", "true or false", ""),
        (('"version": 1', '"version": 2'), "version", "1", ""),
        (("reembody-avatar", "unity-avatar"), "format", "unity-avatar", "reembody-avatar"),
        (("-41.0", "-190"), "axes.SpineX.low_deg", "out of range", "at least -180"),
        (("-41.0", "130"), "axes.SpineX.low_deg", "lies above", "at most 125"),
        (("300.0", "-3"), "axes.SpineX.kp_nm_per_rad", "out of range", "at least 0"),
        (('"HeadX": 10.0', '"HeadX": 170'), "held_deg.HeadX", "cannot be held", "-41 to 125"),
        (("72.0", "NaN"), "total_mass_kg", "not a finite number", ""),
        (("72.0", "1e999"), "total_mass_kg", "too large", ""),
        (("72.0", '"72"'), "total_mass_kg", "Expected a number", ""),
        (('"NeckX": {', '"NeckX": [], "NeckQ": {'), "", "", ""),
        (('"version": 1,', '"version": 1'), "", "This is not JSON", ""),
    ],
)
def test_a_problem_has_its_place(
    change: tuple[str, str], path: str, expected_message: str, valid: str
) -> None:
    """A problem states its path, line and column, and what is valid."""
    with pytest.raises(ConfigError) as caught:
        load_avatar(TEXT.replace(*change, 1))
    problem = caught.value.problems[0]
    assert problem.line > 0
    assert problem.column > 0
    if path:
        assert problem.path == path
    assert expected_message in problem.message
    assert valid in str(problem.valid)


def test_an_unknown_key_is_rejected_with_the_valid_ones() -> None:
    """The error about an unknown key lists the valid ones, and corrects a misspelt one."""
    text = TEXT.replace('"gravity"', '"gravitiy"', 1).replace("kp_nm_per_rad", "kp", 1)
    with pytest.raises(ConfigError) as caught:
        load_avatar(text)
    remedies = {problem.path: problem.remedy for problem in caught.value.problems}
    assert "Did you mean 'gravity'?" in remedies["gravitiy"]
    assert "kp_nm_per_rad" in remedies["axes.SpineX.kp"]
    assert {"gravity", "axes.SpineX.kp_nm_per_rad"} <= set(remedies)


def test_a_duplicate_key_is_rejected() -> None:
    """A duplicate key, of which JSON would silently take the last, is rejected."""
    doubled = TEXT.replace('"gravity": true', '"gravity": true, "gravity": false')
    with pytest.raises(ConfigError, match="gravity"):
        load_avatar(doubled)
