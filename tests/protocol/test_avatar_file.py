"""Tests of the file of an avatar's configuration: lossless, hashed, with located problems."""

import json
import math
from dataclasses import replace

import pytest
from hypothesis import given, settings

from app.protocol import ConfigError
from app.protocol.avatar import (
    avatar_text,
    load_avatar,
    loaded,
    parse_avatar_json,
    single_text,
)
from app.protocol.avatar_editing import edited, read_operations
from app.science.avatar.configuration import (
    AxisSettings,
    Configuration,
    degrees_of,
    lock,
    with_axis,
)
from app.science.avatar.mjcf import default_configuration
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


def test_a_pair_of_layers_is_named_once() -> None:
    """A pair of layers that is named again, in whichever order, is refused with its place."""
    for again, collide in (("left_hand", "torso"), "true"), (("torso", "left_hand"), "false"):
        twice = (
            '"layers": [{"layers": ["torso", "left_hand"], "collide": false},'
            f' {{"layers": {json.dumps(again)}, "collide": {collide}}}], "hips"'
        )
        with pytest.raises(ConfigError) as caught:
            load_avatar(TEXT.replace('"hips"', twice, 1))
        (problem,) = caught.value.problems
        assert problem.path == "layers[1].layers"
        assert "is named already, by layers[0]" in problem.message


def test_a_pair_of_layers_is_two_layers() -> None:
    """A layer twice, which would change nothing, is refused in a file and by the operation."""
    pair = '"layers": ["torso", "torso"], "collide": false'
    with pytest.raises(ConfigError, match="the layer 'torso' twice"):
        load_avatar(TEXT.replace('"hips"', f'"layers": [{{{pair}}}], "hips"', 1))
    operations = read_operations(f'{{"operation": "set_layers", {pair}}}')
    (problem,) = edited(BODY, operations, lambda *_: BODY).problems
    assert "the layer 'torso' twice" in problem.problem.message


def test_messages_say_what_is_wrong_and_not_something_near() -> None:
    """Numbers, versions, hashes and drives that are not valid are told as what they are."""
    joints = json.loads(single_text(default_configuration()))
    del joints["joints"]["LeftFoot"]["shared_drive"]
    shares = {"relative_masses_percent": {"Head": 49.9999999, "Hips": 50}}
    for text, said in (
        (TEXT.replace("72.0", "1e999"), "Numbers go up to 1.8e+308"),
        (TEXT.replace("72.0", str(10**20)), "Whole numbers go up to 9007199254740991"),
        (TEXT.replace('"version": 1', '"version": true'), "version: The version is a number."),
        (
            TEXT.replace('"hips"', f'"humanoid": "{"A" * 64}", "hips"'),
            "digits from 0 to 9 and a to",
        ),
        (json.dumps(joints), "the one that LeftFootZ, LeftFootY share is missing"),
        (json.dumps({**json.loads(TEXT), **shares}), "add up to 99.9999999 %"),
    ):
        with pytest.raises(ConfigError) as caught:
            load_avatar(text)
        assert said in str(caught.value.problems[0])


def test_the_hips_cannot_lag() -> None:
    """A delay of the hips, which have no axis, is refused by name."""
    with pytest.raises(ConfigError) as caught:
        load_avatar(TEXT.replace('"hips"', '"delays_ms": {"Hips": 10}, "hips"', 1))
    (problem,) = caught.value.problems
    assert problem.path == "delays_ms.Hips"
    assert "Hips has no axis" in problem.message


def test_a_refused_value_is_as_it_was_given() -> None:
    """An angle that is refused is stated as given, without the error of converting units."""
    with pytest.raises(ConfigError) as caught:
        load_avatar(TEXT.replace('"HeadX": 10.0', '"HeadX": 165.1', 1))
    assert caught.value.problems[0].value == 165.1


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


def test_a_file_has_joints_or_axes() -> None:
    """A single template with axes is refused, since one of them would count for nothing."""
    both = single_text(default_configuration()).replace('"gravity"', '"axes": {}, "gravity"', 1)
    with pytest.raises(ConfigError) as caught:
        load_avatar(both)
    (problem,) = caught.value.problems
    assert (problem.path, problem.valid) == ("axes", "one of them")


def test_an_axis_too_many_is_named() -> None:
    """A misspelt axis beside the right one is refused by its name and line."""
    line = '"LeftfootX": {"kp_nm_per_rad": 5, "kd_nm_s_per_rad": 1, "max_torque_nm": 9,'
    more = f'"axes": {{\n{line} "low_deg": -1, "high_deg": 1}},'
    text = avatar_text(default_configuration()).replace('"axes": {', more, 1)
    with pytest.raises(ConfigError) as caught:
        load_avatar(text)
    (problem,) = caught.value.problems
    assert problem.path == "axes.LeftfootX"
    assert "LeftfootX" in text.splitlines()[problem.line - 1]


def test_far_too_many_entries_are_counted() -> None:
    """A list of axes that is far too long is refused with how many there are."""
    text = avatar_text(default_configuration())
    gains = '"kp_nm_per_rad": 5, "kd_nm_s_per_rad": 1, "max_torque_nm": 9'
    one = f'{{{gains}, "low_deg": 0, "high_deg": 1}}'
    more = "".join(f'"No{number}": {one},' for number in range(200))
    with pytest.raises(ConfigError, match="There are 291 entries"):
        load_avatar(text.replace('"axes": {', f'"axes": {{{more}', 1))


def test_a_file_in_the_single_template_is_converted() -> None:
    """A file with one joint per part reads as each limit L as [-L, L], and writes as it was."""
    text = single_text(default_configuration())
    read = load_avatar(text).configuration
    foot = read.axes["LeftFootZ"]
    assert (degrees_of(foot.low_rad), degrees_of(foot.high_rad)) == (-35.0, 35.0)
    assert single_text(read) == text
    assert load_avatar(avatar_text(read)).configuration == read


@pytest.mark.parametrize(
    ("before", "after", "path"),
    [
        ('"LeftToes"', '"LeftTail"', "joints.LeftTail"),
        ('"low_deg": -15.0', '"low_deg": 190', "joints.LeftThumbProximal.low_deg"),
        ('"low_deg": -15.0', '"low_deg": 150', "joints.LeftThumbProximal.low_deg"),
        ('"gravity"', '"grav"', "gravity"),
        ('"LeftFootZ": 35.0, ', "", "joints.LeftFoot.limits_deg"),
        ('"LeftFootZ": 35.0', '"LeftFootZ": -35.0', "joints.LeftFoot.limits_deg.LeftFootZ"),
    ],
)
def test_problems_of_a_single_template_name_their_place(before: str, after: str, path: str) -> None:
    """A joint that is not valid is refused with its path, and its line where the file has it."""
    text = single_text(default_configuration()).replace(before, after, 1)
    with pytest.raises(ConfigError) as caught:
        load_avatar(text)
    problem = caught.value.problems[0]
    assert problem.path == path
    assert problem.remedy
