"""The physics avatar of a session: built for the participant, recorded, and handed to a headset."""

import json
from dataclasses import replace

import mujoco
import pytest
from fastapi.testclient import TestClient
from httpx2 import Response

from app.features.record.sessions.contents import content_body, contents_of
from app.protocol.avatar import AvatarFile, configuration_of, loaded
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.simulation import PhysicsAvatar
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.avatar.test_avatars import CAST, new
from tests.features.movement.avatar.test_studies import KEY, study
from tests.protocol.helpers import study as shipped_study
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model, without

STATURE_M = 1.7324
PROTOCOLS = "reembody.v1"


@pytest.fixture
def session(fresh_lab: Lab) -> Json:
    """A session of a study whose avatar has both hands in a cast."""
    new(fresh_lab, "soft", CAST)
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": study("{key: soft, version: 1}")}))
    view: Json = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    return view


def ask(lab: Lab, token: str, body: Json) -> Response:
    """A paired headset asks for its avatar."""
    bearer = {"authorization": f"Bearer {token}"}
    return lab.stranger().post("/api/vr/avatar", json=body, headers=bearer)


@pytest.mark.one_engine
def test_the_model_is_the_configuration_at_the_stature_in_the_studys_boxes(
    fresh_lab: Lab, session: Json
) -> None:
    """MuJoCo loads it; every surface of both tasks is in it; both hashes are on record."""
    token = fresh_lab.headset_token(session["id"])
    told = ok(ask(fresh_lab, token, {"stature_m": STATURE_M}))
    assert told["stature_m"] == 1.732
    assert told["configuration_hash"] == session["avatar_configuration_hash"]
    file = AvatarFile.model_validate(told["configuration"])
    assert loaded(configuration_of(file)).content_hash == told["configuration_hash"]
    assert told["configuration"]["locked_groups"] == ["left_fingers"]
    model = mujoco.MjModel.from_xml_string(told["mjcf"])
    tasks = shipped_study().tasks
    surfaces = [one.key for layout in tasks.layouts().values() for one in layout.surfaces]
    assert {model.geom(name).name for name in surfaces} == set(surfaces)
    (event,) = (one for one in fresh_lab.events(session["id"]) if one["type"] == "avatar_built")
    assert event["data"]["configuration_hash"] == told["configuration_hash"]
    assert "1.732" not in json.dumps(event)
    with fresh_lab.database.reading() as db:
        (content,) = contents_of(db, session["id"], "avatar")
        body = content_body(content)
    assert isinstance(body, dict)
    assert (body["mjcf"], body["model_hash"]) == (told["mjcf"], told["model_hash"])
    assert body["stature_m"] == 1.732


def test_asking_again_records_nothing_new(fresh_lab: Lab, session: Json) -> None:
    """Unless another body is asked for: then both are known, in their order."""
    token = fresh_lab.headset_token(session["id"])
    for stature_m in (1.7, 1.7, 1.8, 1.8):
        ok(ask(fresh_lab, token, {"stature_m": stature_m}))
    types = [event["type"] for event in fresh_lab.events(session["id"])]
    assert types == ["avatar_built", "avatar_built"]


@pytest.mark.one_engine
def test_measured_segments_count(fresh_lab: Lab, session: Json) -> None:
    """A longer thigh is another model; a length that no body has is refused with its reason."""
    token = fresh_lab.headset_token(session["id"])
    usual = ok(ask(fresh_lab, token, {"stature_m": 1.7}))
    measured = ok(ask(fresh_lab, token, {"stature_m": 1.7, "segments_m": {"thigh": 0.45}}))
    assert measured["model_hash"] != usual["model_hash"]
    wrong = {"stature_m": 1.7, "segments_m": {"thigh": 2.9}}
    refusal = error(ask(fresh_lab, token, wrong), 422, "invalid_input")
    assert "thigh" in refusal["message"]
    assert refusal["value"] == {"stature_m": 1.7, "thigh": 2.9}


@pytest.mark.one_engine
def test_a_delayed_copy_needs_no_model(lab: Lab) -> None:
    """It is said so, and nothing is recorded."""
    view = lab.join(kind="test")
    refused = ask(lab, lab.headset_token(view["id"]), {"stature_m": 1.7})
    assert error(refused, 409, "conflict")["value"] == "delayed_copy"
    assert lab.events(view["id"]) == []


@pytest.mark.one_engine
def test_a_client_that_cannot_show_the_avatar_is_refused(fresh_lab: Lab, session: Json) -> None:
    """Nothing is recorded as physics that was not; one that can is welcome."""
    token = fresh_lab.headset_token(session["id"])
    refusal = greet(fresh_lab.stranger(), token, {})
    assert (refusal["type"], refusal["code"]) == ("error", "conflict")
    assert "cannot show the avatar 'physics'" in refusal["message"]
    able = {"avatars": ["delayed_copy", "physics"]}
    assert greet(fresh_lab.stranger(), token, able)["type"] == "welcome"


def greet(client: TestClient, token: str, fields: Json) -> Json:
    """What a headset hears after its hello."""
    protocols = [PROTOCOLS, f"bearer.{token}"]
    with client.websocket_connect("/api/vr/stream", subprotocols=protocols) as socket:
        socket.send_json({"type": "hello", "protocol": 1, "client": "test", **fields})
        answer: Json = socket.receive_json()
    return answer


@pytest.mark.one_engine
def test_a_humanoid_model_lends_its_body(fresh_lab: Lab) -> None:
    """Its pieces of skin, its four fingers and its own legs, scaled to the stature."""
    file = humanoid_file(Model(parts=without("LeftLittle", "RightLittle")))
    stored = ok(fresh_lab.operator.post("/api/humanoids?name=figure.glb", content=file))
    skin = replace(default_configuration(), humanoid=stored["content_hash"], colliders="mesh")
    new(fresh_lab, "soft", skin)
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": study("{key: soft, version: 1}")}))
    view = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    told = ok(ask(fresh_lab, fresh_lab.headset_token(view["id"]), {"stature_m": 1.7}))
    body = PhysicsAvatar(told["mjcf"])
    assert body.model.nmesh > 0
    assert "LeftRingDistal" in body.parts
    assert "LeftLittleDistal" not in body.parts
    hips = float(body.data.xpos[body.model.body("Hips").id][1])
    assert hips == pytest.approx(told["standing_hips_m"])
