"""Tests of the avatar that a study names and its sessions store by hash."""

import pytest

from tests.features.lab import Lab, error, ok
from tests.features.movement.avatar.test_avatars import CAST, PATH, as_json, new, save
from tests.protocol.helpers import edited

KEY = "physics-study"


def study(configuration: str) -> str:
    """Return the shipped study with a physics avatar of this configuration."""
    return edited(
        ("key: reembodiment-latency", f"key: {KEY}"),
        ("avatar: delayed_copy", f"avatar: physics\navatar_configuration: {configuration}"),
    )


def test_a_session_keeps_its_studys_avatar_version(fresh_lab: Lab) -> None:
    """A session keeps the avatar version that its study named when later ones are saved."""
    first = new(fresh_lab, "soft")["newest"]["content_hash"]
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": study("{key: soft, version: 1}")}))
    second = save(fresh_lab, "soft", CAST, 1)["newest"]["content_hash"]
    joined = f"/api/studies/{KEY}/sessions"
    view = ok(fresh_lab.operator.post(joined, json={"kind": "test"}))
    assert (view["avatar"], view["avatar_configuration_hash"]) == ("physics", first)
    changed = {"yaml": study("{key: soft, version: 2}")}
    ok(fresh_lab.operator.post(f"/api/studies/{KEY}/versions", json=changed))
    later = ok(fresh_lab.operator.post(joined, json={"kind": "test"}))
    assert later["avatar_configuration_hash"] == second
    assert fresh_lab.view(view["id"])["avatar_configuration_hash"] == first
    assert ok(fresh_lab.operator.get(f"{PATH}/soft/versions/1"))["sessions"] == 1


@pytest.mark.one_engine
def test_a_study_cannot_name_an_unknown_avatar(fresh_lab: Lab) -> None:
    """A study that names an unknown avatar fails the check and is not stored."""
    body = {"yaml": study("{key: hard, version: 1}")}
    reply = ok(fresh_lab.operator.post("/api/studies/check", json=body))
    assert [one["path"] for one in reply["problems"]] == ["avatar_configuration.key"]
    assert reply["problems"][0]["valid"] == ["standard"]
    refusal = error(fresh_lab.operator.post("/api/studies", json=body), 422, "invalid_config")
    assert refusal["details"][0]["path"] == "avatar_configuration.key"


@pytest.mark.one_engine
def test_locked_groups_are_part_of_the_configuration(fresh_lab: Lab) -> None:
    """Locked joint groups are part of the stored configuration."""
    view = new(fresh_lab, "cast", CAST)
    assert view["newest"]["configuration"] == as_json(CAST)
    assert view["newest"]["configuration"]["locked_groups"] == ["left_fingers"]
