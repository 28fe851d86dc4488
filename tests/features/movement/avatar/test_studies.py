"""Tests of the avatar that a study names and its sessions store by hash."""

import pytest

from app.models import AvatarVersion, StudySession
from app.protocol.avatar import loaded
from app.science.avatar.configuration import without_parts
from tests.features.lab import Lab, error, ok
from tests.features.movement.avatar.test_avatars import CAST, PATH, SOFT, as_json, new, save
from tests.features.record.preflight.test_preflight import checks_of
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
    assert (view["avatar_version"]["key"], view["avatar_version"]["version"]) == ("soft", 1)
    changed = {"yaml": study("{key: soft, version: 2}")}
    ok(fresh_lab.operator.post(f"/api/studies/{KEY}/versions", json=changed))
    later = ok(fresh_lab.operator.post(joined, json={"kind": "test"}))
    assert later["avatar_configuration_hash"] == second
    assert later["avatar_version"]["version"] == 2
    (listed,) = [one for one in ok(fresh_lab.operator.get(PATH)) if one["key"] == "soft"]
    assert listed["content_hashes"] == [first, second]
    assert fresh_lab.view(view["id"])["avatar_configuration_hash"] == first
    assert ok(fresh_lab.operator.get(f"{PATH}/soft/versions/1"))["sessions"] == 1
    for number in (1, 2):
        (use,) = ok(fresh_lab.operator.get(f"{PATH}/soft/versions/{number}"))["used_by"]
        assert (use["study"], use["study_version"]) == (KEY, number)
        assert (use["sessions"], use["running_sessions"]) == (1, 0)
        assert use["is_newest"] == (number == 2)
    fresh_lab.command(later, "start")
    (use,) = ok(fresh_lab.operator.get(f"{PATH}/soft"))["newest"]["used_by"]
    assert use["running_sessions"] == 1
    assert save(fresh_lab, "soft", SOFT, 2)["newest"]["used_by"] != []
    assert ok(fresh_lab.operator.get(f"{PATH}/soft/versions/2"))["content_hash"] == second


@pytest.mark.one_engine
def test_a_study_cannot_name_an_unknown_avatar(fresh_lab: Lab) -> None:
    """A study that names an unknown avatar fails the check and is not stored."""
    body = {"yaml": study("{key: hard, version: 1}")}
    reply = ok(fresh_lab.operator.post("/api/studies/check", json=body))
    assert [one["path"] for one in reply["problems"]] == ["avatar_configuration.key"]
    assert reply["problems"][0]["valid"] == ["standard"]
    refusal = error(fresh_lab.operator.post("/api/studies", json=body), 422, "invalid_config")
    assert refusal["details"][0]["path"] == "avatar_configuration.key"


def test_a_stored_avatar_without_parts_that_a_session_needs_is_found_before_it(
    fresh_lab: Lab,
) -> None:
    """Earlier releases stored avatars without a hand: studies, pre-flight and headset refuse them.

    Studies and sessions that use one already are still listed and read.
    """
    new(fresh_lab, "soft")
    stored = {"yaml": study("{key: soft, version: 1}")}
    ok(fresh_lab.operator.post("/api/studies", json=stored))
    view = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    one_handed = loaded(without_parts(SOFT, frozenset({"RightHand"})))
    with fresh_lab.database.writing() as db:
        row = db.get_one(AvatarVersion, ("soft", 1))
        row.canonical_json, row.content_hash = one_handed.canonical_json, one_handed.content_hash
        session = db.get_one(StudySession, view["id"])
        session.avatar_configuration_hash = one_handed.content_hash
    missing = "No body can be built without RightHand."
    (problem,) = ok(fresh_lab.operator.post("/api/studies/check", json=stored))["problems"]
    assert problem["path"] == "avatar_configuration.version"
    assert problem["message"] == f"Version 1 of the avatar 'soft' cannot be used: {missing}"
    assert "save one in which these parts have all their axes" in problem["remedy"]
    path = f"/api/studies/{KEY}/versions"
    error(fresh_lab.operator.post(path, json=stored), 422, "invalid_config")
    check = checks_of(fresh_lab, view["id"])["configuration"]
    assert (check["code"], check["status"]) == ("configuration.incomplete", "fail")
    assert missing in check["details"]
    headset = {"authorization": f"Bearer {fresh_lab.headset_token(view['id'])}"}
    asked = fresh_lab.stranger().post("/api/vr/avatar", json={"stature_m": 1.7}, headers=headset)
    assert missing in error(asked, 409, "conflict")["message"]
    assert ok(fresh_lab.operator.get(f"/api/studies/{KEY}"))["key"] == KEY
    shown = ok(fresh_lab.operator.get(f"{PATH}/soft"))["newest"]
    assert shown["configuration"] == as_json(one_handed.configuration)


@pytest.mark.one_engine
def test_locked_groups_are_part_of_the_configuration(fresh_lab: Lab) -> None:
    """Locked joint groups are part of the stored configuration."""
    view = new(fresh_lab, "cast", CAST)
    assert view["newest"]["configuration"] == as_json(CAST)
    assert view["newest"]["configuration"]["locked_groups"] == ["left_fingers"]
