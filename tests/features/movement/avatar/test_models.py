"""Tests of avatar models over HTTP: the same content gives the same text, sent once."""

import hashlib
import subprocess
import sys
from xml.etree import ElementTree as ET

import pytest

from app.models import AvatarVersion
from app.protocol.avatar import loaded
from app.science.avatar.body import FINGER_PARTS
from app.science.avatar.configuration import lock, without_parts
from app.science.avatar.mjcf import avatar_model
from tests.features.lab import Lab, error, ok
from tests.features.movement.avatar.test_avatars import CAST, PATH, SHIPPED, as_json, new, save

pytestmark = pytest.mark.one_engine


def test_a_models_etag_is_its_hash(fresh_lab: Lab) -> None:
    """A model's ETag is the hash of its text, and a client that has it gets 304."""
    path = f"{PATH}/standard/model?stature_m=1.7001&version=1"
    answer = fresh_lab.operator.get(path)
    assert answer.headers["content-type"] == "application/xml"
    assert answer.text == avatar_model(SHIPPED, 1.7).mjcf
    tag = answer.headers["etag"]
    assert tag == f'"{hashlib.sha256(answer.content).hexdigest()}"'
    repeated = fresh_lab.operator.get(path, headers={"if-none-match": f'"other", W/{tag}'})
    assert (repeated.status_code, repeated.content, repeated.headers["etag"]) == (304, b"", tag)
    taller = fresh_lab.operator.get(f"{PATH}/standard/model?stature_m=1.8")
    assert taller.headers["etag"] != tag


def test_a_configuration_can_be_tried_without_storing_it(fresh_lab: Lab) -> None:
    """The model of a draft is that of the saved version, a box to drop is added, none is stored."""
    draft = {"configuration": as_json(SHIPPED), "stature_m": 1.7001}
    before = fresh_lab.operator.get(PATH).json()
    plain = fresh_lab.operator.post(f"{PATH}/model", json=draft)
    assert plain.text == avatar_model(SHIPPED, 1.7).mjcf
    assert plain.headers["etag"] == f'"{hashlib.sha256(plain.content).hexdigest()}"'
    boxed = fresh_lab.operator.post(f"{PATH}/model", json={**draft, "box": {"mass_kg": 3}})
    root = ET.fromstring(boxed.text)  # noqa: S314 - our own text
    box = root.findall("worldbody/body")[-1]
    geom = box.find("geom")
    assert geom is not None
    assert (box.get("name"), box.get("gravcomp"), geom.get("mass")) == ("box", "1", "3")
    assert fresh_lab.operator.get(PATH).json() == before


def test_a_configuration_that_cannot_be_built_is_not_tried(fresh_lab: Lab) -> None:
    """A draft that lacks a forearm, names an unknown body or contradicts itself is refused."""
    armless = as_json(without_parts(SHIPPED, frozenset({"LeftLowerArm"})))
    answer = fresh_lab.operator.post(
        f"{PATH}/model", json={"configuration": armless, "stature_m": 1.7}
    )
    assert "LeftLowerArm" in error(answer, 409, "conflict")["message"]
    unknown = as_json(SHIPPED) | {"humanoid": "0" * 64}
    answer = fresh_lab.operator.post(
        f"{PATH}/model", json={"configuration": unknown, "stature_m": 1.7}
    )
    assert "humanoid" in str(error(answer, 422, "invalid_config")["details"])


def test_locked_groups_have_no_hinges_in_the_model(fresh_lab: Lab) -> None:
    """Locked joint groups have no hinges in the model of that version."""
    new(fresh_lab, "soft")
    save(fresh_lab, "soft", CAST, 1)
    for query, hinges in (("&version=1", 89), ("&version=2", 69), ("", 69)):
        answer = fresh_lab.operator.get(f"{PATH}/soft/model?stature_m=1.7{query}")
        root = ET.fromstring(answer.text)  # noqa: S314 - our own text
        assert sum(1 for _ in root.iter("joint")) == hinges


def test_a_model_may_lack_fingers_but_no_arm(fresh_lab: Lab) -> None:
    """An avatar without fingers is built; one without a forearm is refused before it is stored.

    A version that an earlier release stored without one is not built.
    """
    new(fresh_lab, "mitten", without_parts(SHIPPED, frozenset(FINGER_PARTS)))
    assert fresh_lab.operator.get(f"{PATH}/mitten/model?stature_m=1.7").is_success
    armless = without_parts(SHIPPED, frozenset({"LeftLowerArm"}))
    request = {
        "key": "armless",
        "title": "Armless",
        "origin": "by_hand",
        "configuration": as_json(armless),
    }
    refused = error(fresh_lab.operator.post(PATH, json=request), 422, "invalid_config")
    (detail,) = refused["details"]
    assert (detail["path"], detail["value"]) == ("configuration.axes", ["LeftLowerArm"])
    assert detail["message"] == "No body can be built without LeftLowerArm."
    edit = {"configuration": as_json(armless), "operations": []}
    (told,) = ok(fresh_lab.operator.post(f"{PATH}/edit", json=edit))["problems"]
    assert told["message"] == detail["message"]
    new(fresh_lab, "armless")
    content = loaded(armless)
    with fresh_lab.database.writing() as db:
        row = db.get_one(AvatarVersion, ("armless", 1))
        row.canonical_json, row.content_hash = content.canonical_json, content.content_hash
    answer = fresh_lab.operator.get(f"{PATH}/armless/model?stature_m=1.7")
    assert "LeftLowerArm" in error(answer, 409, "conflict")["message"]


def test_an_impossible_stature_is_refused(fresh_lab: Lab) -> None:
    """An avatar model's stature must be a number from 0.5 to 2.6 m."""
    for stature in ("0.4", "2.7", "nan", "tall"):
        answer = fresh_lab.operator.get(f"{PATH}/standard/model?stature_m={stature}")
        error(answer, 422, "invalid_input")


def test_locking_keeps_the_rest_of_the_model() -> None:
    """Locking a group at another angle changes the model but not its masses."""
    locked = lock(SHIPPED, "left_fingers", {"LeftIndexProximalZ": 0.5})
    flat, bent = (avatar_model(one, 1.7) for one in (CAST, locked))
    assert flat.mjcf != bent.mjcf
    assert flat.masses == bent.masses


def test_writing_a_model_does_not_load_mujoco() -> None:
    """A server that only writes models does not load MuJoCo."""
    code = (
        "import sys, app.main; from app.science.avatar.mjcf import avatar_model;"
        "from app.science.avatar.mjcf import default_configuration;"
        "avatar_model(default_configuration(), 1.7); print('mujoco' in sys.modules)"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120
    )
    assert result.stdout.strip() == "False"
