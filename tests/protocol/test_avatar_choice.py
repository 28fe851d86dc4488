"""Tests of the avatar of a study: moved by physics, or a delayed copy."""

import json

import pytest

from app.protocol import ConfigError, load_study
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
