"""Tests of the avatar of a study: moved by physics, or a delayed copy."""

import json

import pytest

from app.protocol import ConfigError, compile_plan, load_study, parse_study_json, sequences
from app.science.avatar.mjcf import default_configuration
from tests.protocol.helpers import edited, instruments, loaded, problems

AVATARS = {"standard": 2, "soft": 1}


def physics(configuration: str = "{key: standard, version: 1}") -> str:
    """Return the shipped study with a physics avatar."""
    return edited(
        ("avatar: delayed_copy", f"avatar: physics\navatar_configuration: {configuration}")
    )


def test_a_study_names_the_version_of_its_avatar() -> None:
    """The avatar's version is part of a study's content but not of its design."""
    study = loaded(physics())
    assert study.protocol.avatar == "physics"
    assert json.loads(study.canonical_json)["avatar_configuration"] == {
        "key": "standard",
        "version": 1,
    }
    assert study.content_hash != loaded().content_hash
    assert study.protocol.design_hash == loaded().protocol.design_hash
    assert "avatar_configuration" not in json.loads(loaded().canonical_json)


def test_a_physics_avatar_needs_a_configuration() -> None:
    """A physics avatar without a configuration raises an error that lists the existing ones."""
    text = edited(("avatar: delayed_copy", "avatar: physics"))
    (problem,) = problems(text)
    assert problem.path == "avatar_configuration"
    assert "{key: standard, version: 1}" in problem.remedy
    with pytest.raises(ConfigError) as caught:
        load_study(text, instruments=instruments(), avatars=AVATARS)
    assert caught.value.problems[0].valid == ["soft", "standard"]
    assert "{key: standard, version: 1}" in caught.value.problems[0].remedy


def test_a_delayed_copy_has_no_configuration() -> None:
    """A configuration of a delayed copy is rejected, since it would not be used."""
    (problem,) = problems(physics().replace("avatar: physics", "avatar: delayed_copy"))
    assert (problem.path, "left out" in str(problem.valid)) == ("avatar_configuration", True)
    assert problem.line > 0


@pytest.mark.parametrize(
    ("configuration", "path", "expected_message"),
    [
        ("{key: hard, version: 1}", "avatar_configuration.key", "no avatar 'hard'"),
        ("{key: standard, version: 3}", "avatar_configuration.version", "no version 3"),
        ("{key: standard, version: 0}", "avatar_configuration.version", "out of range"),
        ("{key: standard}", "avatar_configuration.version", "missing"),
        ("standard", "avatar_configuration", "Expected a mapping"),
    ],
)
def test_an_unknown_configuration_is_rejected(
    configuration: str, path: str, expected_message: str
) -> None:
    """An unknown configuration raises an error that states its place in the file."""
    with pytest.raises(ConfigError) as caught:
        load_study(physics(configuration), instruments=instruments(), avatars=AVATARS)
    (problem,) = caught.value.problems
    assert problem.path == path
    assert expected_message in problem.message
    assert problem.line > 0


def test_without_known_avatars_only_the_file_is_checked() -> None:
    """Where no avatars are known, a file with any configuration can be loaded."""
    assert loaded(physics("{key: hard, version: 7}")).protocol.avatar_configuration is not None


FEET = "      - limb: foot\n"


def with_changes(changes: str, *, avatar: str = "physics") -> str:
    """Return the shipped study with changes to the avatar in the phase of the feet."""
    text = physics() if avatar == "physics" else edited()
    assert text.count(FEET) == 1
    return text.replace(FEET, f"{FEET}        avatar_changes: {changes}\n")


@pytest.mark.parametrize(
    ("changes", "place", "said"),
    [
        ("{casts: [{group: left_wing}]}", "casts[0].group", "no body group 'left_wing'"),
        ("{casts: [{group: Hips}]}", "casts[0].group", "No axis of Hips is driven"),
        (
            "{casts: [{group: left_arm, held_deg: {LeftLowerArmY: 170}}]}",
            "casts[0].held_deg.LeftLowerArmY",
            "cannot be held at 170 deg",
        ),
        ("{colliders: [{group: all, kind: mesh}]}", "colliders[0].kind", "no mesh colliders"),
        ("{gains: [{motors: left_arm}]}", "gains[0]", "Nothing is said about the motors"),
        (
            "{gains: [{motors: head, kp_factor: 2.0, kp_nm_per_rad: 3}]}",
            "gains[0].kp_factor",
            "Both a factor and a value",
        ),
        ("{gains: [{motors: head, kp_factor: 9}]}", "gains[0].kp_factor", "9"),
        ("{gravitation: false}", "gravitation", "gravitation"),
    ],
)
def test_a_study_cannot_change_what_its_avatar_does_not_have(
    changes: str, place: str, said: str
) -> None:
    """A change that the avatar cannot have is a problem with its place and what is valid."""
    with pytest.raises(ConfigError) as caught:
        load_study(
            with_changes(changes),
            instruments=instruments(),
            avatars=AVATARS,
            configured=lambda _key, _version: default_configuration(),
        )
    (problem,) = caught.value.problems
    assert problem.path == f"procedure.block.phases[1].avatar_changes.{place}"
    assert said in problem.message
    assert problem.valid


def test_a_delayed_copy_has_nothing_to_change() -> None:
    """Changes to the avatar are a problem where the avatar is a delayed copy."""
    with pytest.raises(ConfigError, match="nothing to change"):
        load_study(with_changes("{gravity: false}", avatar="copy"), instruments=instruments())


def test_changes_reach_the_plan_and_only_then_the_hash() -> None:
    """Changes to the avatar are in the plan of their phase; a study without any keeps its hash."""
    plain = load_study(physics(), instruments=instruments())
    changed = load_study(with_changes("{gravity: false}"), instruments=instruments())
    assert "avatar_changes" not in plain.canonical_json
    assert plain.content_hash != changed.content_hash
    again = parse_study_json(changed.canonical_json)
    steps = compile_plan(again, sequences(again)[0])
    found = {one.key: one.avatar_changes.as_json() for one in steps if one.avatar_changes}
    feet = [f"block{number}.foot" for number in (1, 2, 3)]
    assert found == {key: {"gravity": False} for key in feet}
