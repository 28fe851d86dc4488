"""Which avatar a study's sessions use: named by the study, kept on the session by its hash."""

import pytest

from tests.features.lab import Lab, error, ok
from tests.features.movement.avatar.test_avatars import CAST, PATH, as_json, new, save
from tests.protocol.helpers import edited

KEY = "physics-study"


def study(configuration: str) -> str:
    """The shipped study with a physics avatar."""
    return edited(
        ("key: reembodiment-latency", f"key: {KEY}"),
        ("avatar: delayed_copy", f"avatar: physics\navatar_configuration: {configuration}"),
    )


def test_a_session_keeps_the_content_that_its_study_named(fresh_lab: Lab) -> None:
    """Also when the avatar gets further versions; another version is another study version."""
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
def test_a_study_cannot_name_an_avatar_that_is_not_there(fresh_lab: Lab) -> None:
    """Neither while it is written nor when it is stored."""
    body = {"yaml": study("{key: hard, version: 1}")}
    told = ok(fresh_lab.operator.post("/api/studies/check", json=body))
    assert [one["path"] for one in told["problems"]] == ["avatar_configuration.key"]
    assert told["problems"][0]["valid"] == ["standard"]
    refusal = error(fresh_lab.operator.post("/api/studies", json=body), 422, "invalid_config")
    assert refusal["details"][0]["path"] == "avatar_configuration.key"


@pytest.mark.one_engine
def test_a_tuned_cast_is_what_its_file_says(fresh_lab: Lab) -> None:
    """Locked groups are part of the content that a session records."""
    view = new(fresh_lab, "cast", CAST)
    assert view["newest"]["configuration"] == as_json(CAST)
    assert view["newest"]["configuration"]["locked_groups"] == ["left_fingers"]
