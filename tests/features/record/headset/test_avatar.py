"""Tests of a session's physics avatar: built for the participant, recorded, sent to the headset."""

import json
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from fastapi.testclient import TestClient
from httpx2 import Response
from sqlalchemy import update

from app.features.record.sessions.contents import content_body, contents_of
from app.models import StudySession
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
    """Return a session of a study whose avatar has its left fingers locked."""
    new(fresh_lab, "soft", CAST)
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": study("{key: soft, version: 1}")}))
    view: Json = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    return view


def request_avatar(lab: Lab, token: str, body: Json) -> Response:
    """Request the avatar as a paired headset."""
    bearer = {"authorization": f"Bearer {token}"}
    return lab.stranger().post("/api/vr/avatar", json=body, headers=bearer)


@pytest.mark.one_engine
def test_the_avatar_model_has_the_stature_and_the_studys_surfaces(
    fresh_lab: Lab, session: Json
) -> None:
    """The avatar's model has the requested stature and every surface of both tasks.

    MuJoCo loads it, and the configuration and both hashes are in the record.
    """
    token = fresh_lab.headset_token(session["id"])
    reply = ok(request_avatar(fresh_lab, token, {"stature_m": STATURE_M}))
    assert reply["stature_m"] == 1.732
    assert reply["configuration_hash"] == session["avatar_configuration_hash"]
    file = AvatarFile.model_validate(reply["configuration"])
    assert loaded(configuration_of(file)).content_hash == reply["configuration_hash"]
    assert reply["configuration"]["locked_groups"] == ["left_fingers"]
    model = mujoco.MjModel.from_xml_string(reply["mjcf"])
    tasks = shipped_study().tasks
    surfaces = [one.key for layout in tasks.layouts().values() for one in layout.surfaces]
    assert {model.geom(name).name for name in surfaces} == set(surfaces)
    (event,) = (one for one in fresh_lab.events(session["id"]) if one["type"] == "avatar_built")
    assert event["data"]["configuration_hash"] == reply["configuration_hash"]
    assert "1.732" not in json.dumps(event["data"])
    with fresh_lab.database.reading() as db:
        (content,) = contents_of(db, session["id"], "avatar")
        body = content_body(content)
    assert isinstance(body, dict)
    assert (body["mjcf"], body["model_hash"]) == (reply["mjcf"], reply["model_hash"])
    assert body["stature_m"] == 1.732


def test_a_repeated_avatar_request_records_nothing_new(fresh_lab: Lab, session: Json) -> None:
    """Requesting the same avatar again records nothing; one of another stature is recorded."""
    token = fresh_lab.headset_token(session["id"])
    for stature_m in (1.7, 1.7, 1.8, 1.8):
        ok(request_avatar(fresh_lab, token, {"stature_m": stature_m}))
    types = [event["type"] for event in fresh_lab.events(session["id"])]
    assert types == ["avatar_built", "avatar_built"]


@pytest.mark.one_engine
def test_nobody_gets_another_body_after_the_end(fresh_lab: Lab, session: Json) -> None:
    """After a session's end its recorded body may be fetched again, but no other one is built."""
    token = fresh_lab.headset_token(session["id"])
    worn = ok(request_avatar(fresh_lab, token, {"stature_m": 1.7}))
    with fresh_lab.database.writing() as db:
        own = StudySession.id == session["id"]
        db.execute(update(StudySession).where(own).values(status="completed"))
    again = ok(request_avatar(fresh_lab, token, {"stature_m": 1.7}))
    assert again["model_hash"] == worn["model_hash"]
    refused = request_avatar(fresh_lab, token, {"stature_m": 0.6})
    assert error(refused, 409, "conflict")["value"] == "completed"
    types = [event["type"] for event in fresh_lab.events(session["id"])]
    assert types.count("avatar_built") == 1


@pytest.mark.one_engine
def test_measured_segment_lengths_change_the_model(fresh_lab: Lab, session: Json) -> None:
    """A measured segment length changes the model; an impossible one is refused with its value."""
    token = fresh_lab.headset_token(session["id"])
    usual = ok(request_avatar(fresh_lab, token, {"stature_m": 1.7}))
    measured = ok(
        request_avatar(fresh_lab, token, {"stature_m": 1.7, "segments_m": {"thigh": 0.45}})
    )
    assert measured["model_hash"] != usual["model_hash"]
    wrong = {"stature_m": 1.7, "segments_m": {"thigh": 2.9}}
    refusal = error(request_avatar(fresh_lab, token, wrong), 422, "invalid_input")
    assert "thigh" in refusal["message"]
    assert refusal["value"] == {"stature_m": 1.7, "thigh": 2.9}
    for no_number in ({"stature_m": True}, {"stature_m": "1.75"}):
        error(request_avatar(fresh_lab, token, no_number), 422, "invalid_input")


@pytest.mark.one_engine
def test_a_shipped_body_has_the_arms_that_were_measured(fresh_lab: Lab) -> None:
    """The shipped body's arms are as long as the participant's, and the record says how long."""
    text = study("{key: standard, version: 2}")
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": text}))
    view: Json = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    token = fresh_lab.headset_token(view["id"])
    usual = ok(request_avatar(fresh_lab, token, {"stature_m": 1.7}))
    assert usual["segments_m"] == {}
    arms_m = {"upper_arm": 0.27, "forearm": 0.21}
    # Of the lengths that are measured, only those of the arms can be given to this body.
    wish = {"stature_m": 1.7, "segments_m": {**arms_m, "thigh": 0.42}}
    fitted = ok(request_avatar(fresh_lab, token, wish))
    assert (fitted["humanoid"], fitted["segments_m"]) == (usual["humanoid"], arms_m)
    for reply, expected_m in ((usual, None), (fitted, arms_m)):
        model = mujoco.MjModel.from_xml_string(reply["mjcf"])
        for side in ("Left", "Right"):
            lengths = (("LowerArm", "upper_arm"), ("Hand", "forearm"))
            for part, name in lengths:
                length_m = float(np.linalg.norm(model.body(f"{side}{part}").pos))
                if expected_m is None:
                    assert length_m > arms_m[name] + 0.02
                else:
                    assert length_m == pytest.approx(expected_m[name], abs=1e-5)
        assert np.linalg.norm(model.body("LeftLowerLeg").pos) != pytest.approx(0.42, abs=1e-3)
    with fresh_lab.database.reading() as db:
        recorded = [content_body(row) for row in contents_of(db, view["id"], "avatar")]
    assert [one["segments_m"] for one in recorded if isinstance(one, dict)] == [{}, arms_m]


@pytest.mark.one_engine
def test_a_delayed_copy_has_no_avatar_model(lab: Lab) -> None:
    """The avatar of a session with a delayed copy is refused, and nothing is recorded."""
    view = lab.join(kind="test")
    refused = request_avatar(lab, lab.headset_token(view["id"]), {"stature_m": 1.7})
    assert error(refused, 409, "conflict")["value"] == "delayed_copy"
    assert lab.events(view["id"]) == []


@pytest.mark.one_engine
def test_a_client_that_cannot_show_the_avatar_is_refused(fresh_lab: Lab, session: Json) -> None:
    """A client that cannot show the physics avatar is refused; one that can is welcomed."""
    token = fresh_lab.headset_token(session["id"])
    refusal = greet(fresh_lab.stranger(), token, {})
    assert (refusal["type"], refusal["code"]) == ("error", "conflict")
    assert "cannot show the avatar 'physics'" in refusal["message"]
    able = {"avatars": ["delayed_copy", "physics"]}
    assert greet(fresh_lab.stranger(), token, able)["type"] == "welcome"


def greet(client: TestClient, token: str, fields: Json) -> Json:
    """Return the server's answer to a headset's hello."""
    protocols = [PROTOCOLS, f"bearer.{token}"]
    with client.websocket_connect("/api/vr/stream", subprotocols=protocols) as socket:
        socket.send_json({"type": "hello", "protocol": 1, "client": "test", **fields})
        answer: Json = socket.receive_json()
    return answer


@pytest.mark.one_engine
def test_an_avatar_takes_its_body_from_a_humanoid_model(fresh_lab: Lab) -> None:
    """An avatar built from a humanoid model has its meshes, fingers and leg length."""
    file = humanoid_file(Model(parts=without("LeftLittle", "RightLittle")))
    stored = ok(fresh_lab.operator.post("/api/humanoids?name=figure.glb", content=file))
    skin = replace(default_configuration(), humanoid=stored["content_hash"], colliders="mesh")
    new(fresh_lab, "soft", skin)
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": study("{key: soft, version: 1}")}))
    view = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    reply = ok(request_avatar(fresh_lab, fresh_lab.headset_token(view["id"]), {"stature_m": 1.7}))
    body = PhysicsAvatar(reply["mjcf"])
    assert body.model.nmesh > 0
    assert "LeftRingDistal" in body.parts
    assert "LeftLittleDistal" not in body.parts
    hips = float(body.data.xpos[body.model.body("Hips").id][1])
    assert hips == pytest.approx(reply["standing_hips_m"])
