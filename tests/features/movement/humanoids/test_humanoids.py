"""Tests of humanoid models: stored once, described, and used as an avatar's body."""

import hashlib
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from httpx2 import Response
from sqlalchemy import func, select

from app.adapters.humanoids import read_humanoid
from app.database import open_database
from app.features.movement.files import drop_unused, plain_pieces
from app.models import CaptureContent, HumanoidRow
from app.protocol.avatar import avatar_text, file_of, load_avatar, loaded
from app.protocol.humanoid import figure_json, parse_figure
from app.science.avatar.body import PART_NAMES
from app.science.avatar.mjcf import avatar_model
from tests.api.people import sign_in
from tests.features.care.backups.lab import make, put_back
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.avatar.test_avatars import PATH as AVATARS
from tests.features.movement.avatar.test_avatars import SHIPPED, as_json, new
from tests.science.avatar.figures import figure
from tests.support.humanoid_files import dog_file, humanoid_file
from tests.support.humanoid_model import Model, without
from tests.support.sqlite import fresh_sqlite

PATH = "/api/humanoids"
FIVE, FOUR = humanoid_file(), humanoid_file(Model(parts=without("Little"), vrm=1))
HASH = hashlib.sha256(FIVE).hexdigest()
SHIPPED_BODIES = 3


def upload(lab: Lab, data: bytes = FIVE, name: str = "figure.glb") -> Response:
    """Upload a model's file."""
    return lab.operator.post(f"{PATH}?name={name}", content=data)


def counted(lab: Lab) -> tuple[int, int]:
    """Return the numbers of stored models and contents."""
    with lab.database.reading() as db:
        return (
            db.scalars(select(func.count()).select_from(HumanoidRow)).one(),
            db.scalars(select(func.count()).select_from(CaptureContent)).one(),
        )


def test_an_uploaded_model_is_described_and_downloaded_unchanged(fresh_lab: Lab) -> None:
    """An uploaded model is described by parts, fingers and lengths, and downloads unchanged."""
    answer = upload(fresh_lab)
    assert answer.status_code == 201
    view: Json = answer.json()
    assert view["content_hash"] == HASH
    assert (view["present"], view["absent"], view["simple"]) == (list(PART_NAMES), [], [])
    assert (view["left_fingers"], view["right_fingers"], view["bones_by"]) == (5, 5, "names")
    assert view["stature_m"] == pytest.approx(1.7, abs=1e-5)
    assert view["segments_m"]["thigh"] == pytest.approx(0.4165, abs=1e-5)
    pieces = {piece["part"]: piece for piece in view["convex_pieces"]}
    assert pieces["LeftHand"] == {"part": "LeftHand", "corners": 8, "outside_m": 0.0}
    assert (view["size_bytes"], view["file_name"]) == (len(FIVE), "figure.glb")
    assert ok(fresh_lab.operator.get(f"{PATH}/{HASH}")) == view
    sent = fresh_lab.operator.get(f"{PATH}/{HASH}/file")
    assert sent.content == FIVE
    assert "figure.glb" in sent.headers["content-disposition"]
    page = ok(fresh_lab.operator.get(PATH))
    assert page["total"] == 1 + SHIPPED_BODIES
    (listed,) = (one for one in page["humanoids"] if one["content_hash"] == HASH)
    assert listed == {name: view[name] for name in listed}
    audited = ok(fresh_lab.operator.get("/api/audit"))["entries"][0]
    assert (audited["action"], audited["subject"]) == ("humanoid.added", f"humanoid:{HASH[:12]}")


def test_the_same_file_is_stored_once(fresh_lab: Lab) -> None:
    """Uploading the same file under another name returns the first model."""
    first, repeated = upload(fresh_lab), upload(fresh_lab, name="copy.glb")
    assert (first.status_code, repeated.status_code) == (201, 200)
    assert first.json() == repeated.json()
    assert counted(fresh_lab) == (1 + SHIPPED_BODIES, 1 + SHIPPED_BODIES)


@pytest.mark.one_engine
def test_a_model_that_is_not_humanoid_is_refused(fresh_lab: Lab) -> None:
    """A model without human parts, or a damaged file, is refused and not stored."""
    dog = error(upload(fresh_lab, dog_file(), "dog.glb"), 422, "invalid_input")
    assert "no LeftUpperArm, LeftLowerArm, LeftHand" in dog["message"]
    # What to do is said in words: who uploads has the program, not its repository.
    assert "export it as one file" in dog["remedy"]
    assert "docs/" not in dog["remedy"]
    cut = error(upload(fresh_lab, FIVE[:4000]), 422, "invalid_input")
    assert f"4000 of {len(FIVE)} bytes" in cut["message"]

    def far(document: Json) -> None:
        document["accessors"][0]["count"] = 10**9

    odd = error(upload(fresh_lab, humanoid_file(Model(edit=far))), 422, "invalid_input")
    assert odd["details"] == [{"path": "accessors.0", "message": odd["details"][0]["message"]}]
    error(upload(fresh_lab, b""), 422, "invalid_input")
    assert counted(fresh_lab) == (SHIPPED_BODIES, SHIPPED_BODIES)
    error(fresh_lab.operator.get(f"{PATH}/{HASH}"), 404, "not_found")
    error(fresh_lab.operator.get(f"{PATH}/{HASH}/file"), 404, "not_found")


@pytest.mark.one_engine
def test_an_avatar_has_the_body_of_its_model(fresh_lab: Lab) -> None:
    """An avatar with a humanoid model has that model's fingers and convex pieces."""
    four = upload(fresh_lab, FOUR).json()
    assert (four["left_fingers"], four["bones_by"]) == (4, "vrm")
    assert "LeftLittleProximal" in four["absent"]
    skin = replace(SHIPPED, humanoid=four["content_hash"], colliders="mesh")
    view = new(fresh_lab, "skinned", skin)
    assert view["newest"]["configuration"]["humanoid"] == four["content_hash"]
    answer = fresh_lab.operator.get(f"{AVATARS}/skinned/model?stature_m=1.7")
    with fresh_lab.database.reading() as db:
        own = parse_figure(db.get_one(HumanoidRow, four["content_hash"]).figure)
    assert answer.text == avatar_model(skin, 1.7, figure=own).mjcf
    root = ET.fromstring(answer.text)  # noqa: S314 - our own text
    assert len(list(root.iter("mesh"))) == len(four["convex_pieces"]) == 46
    assert not [one for one in root.iter("body") if "Little" in one.get("name", "")]


@pytest.mark.one_engine
def test_mesh_colliders_need_a_stored_model(fresh_lab: Lab) -> None:
    """A configuration with mesh colliders or a humanoid that is not stored is refused."""
    for configuration, path in (
        (replace(SHIPPED, colliders="mesh"), "configuration.colliders"),
        (replace(SHIPPED, part_colliders={"Head": "mesh"}), "configuration.part_colliders.Head"),
        (replace(SHIPPED, humanoid=HASH), "configuration.humanoid"),
    ):
        body = {
            "key": "skinned",
            "title": "Skinned",
            "origin": "by_hand",
            "configuration": as_json(configuration),
        }
        refusal = error(fresh_lab.operator.post(AVATARS, json=body), 422, "invalid_config")
        assert refusal["details"][0]["path"] == path
        assert "pload" in refusal["details"][0]["remedy"]


@pytest.mark.one_engine
def test_a_configuration_file_with_a_missing_model_is_reported(fresh_lab: Lab) -> None:
    """The check of a configuration file reports a missing humanoid model until it is uploaded."""
    text = avatar_text(replace(SHIPPED, humanoid=HASH, colliders="mesh"))
    (problem,) = ok(fresh_lab.operator.post(f"{AVATARS}/check", json={"text": text}))["problems"]
    assert (problem["path"], problem["value"]) == ("humanoid", HASH)
    upload(fresh_lab)
    assert ok(fresh_lab.operator.post(f"{AVATARS}/check", json={"text": text}))["ok"]
    alone = text.replace(f'  "humanoid": "{HASH}",\n', "")
    (problem,) = ok(fresh_lab.operator.post(f"{AVATARS}/check", json={"text": alone}))["problems"]
    assert (problem["path"], problem["line"]) == (
        "colliders",
        alone[: alone.index('"colliders"')].count("\n") + 1,
    )


def test_a_configuration_without_a_model_keeps_its_hash() -> None:
    """The canonical form of a configuration has a humanoid only if one is named."""
    assert "humanoid" not in loaded(SHIPPED).canonical_json
    named = replace(SHIPPED, humanoid=HASH)
    assert f'"humanoid":"{HASH}"' in loaded(named).canonical_json
    assert loaded(named).content_hash != loaded(SHIPPED).content_hash
    text = file_of(named).model_dump_json()
    assert load_avatar(text).configuration == named


def test_a_figure_survives_being_stored() -> None:
    """A figure read back from its stored text is the same figure."""
    for own in (figure(), figure("Little")):
        text = figure_json(own)
        assert figure_json(parse_figure(text)) == text
        assert parse_figure(text).scaled(1.8) == own.scaled(1.8)


def test_a_restored_model_is_the_file_that_was_uploaded(fresh_lab: Lab, tmp_path: Path) -> None:
    """A humanoid model restored from a backup is the uploaded file."""
    upload(fresh_lab)
    with fresh_lab.database.writing() as db:
        drop_unused(db, HASH)
    make(fresh_lab.database, tmp_path / "all.reembody")
    other = open_database(fresh_sqlite(tmp_path / "other.sqlite"))
    put_back(other, tmp_path / "all.reembody")
    with other.reading() as db:
        assert b"".join(plain_pieces(db, HASH)) == FIVE
        assert parse_figure(db.get_one(HumanoidRow, HASH).figure).finger_count("Left") == 5
    other.close()


@pytest.mark.one_engine
def test_only_designers_may_upload_models(fresh_lab: Lab) -> None:
    """An analyst may see humanoid models but not upload one."""
    upload(fresh_lab)
    analyst = sign_in(fresh_lab, "analyst")
    assert ok(analyst.get(PATH))["total"] == 1 + SHIPPED_BODIES
    assert analyst.post(f"{PATH}?name=a.glb", content=FOUR).status_code == 403


def test_a_stored_model_has_a_binding(fresh_lab: Lab) -> None:
    """The binding of a stored model is that of its file, and of no other; lab members may read."""
    upload(fresh_lab, FOUR)
    content_hash = hashlib.sha256(FOUR).hexdigest()
    analyst = sign_in(fresh_lab, "analyst")
    view: Json = ok(analyst.get(f"{PATH}/{content_hash}/binding"))
    own = read_humanoid(FOUR).binding
    assert view["parts"] == list(own.parts)
    assert view["parents"] == list(own.parents)
    assert view["nodes"] == list(own.nodes)
    assert (view["parts"][0], view["parents"][0]) == ("Hips", -1)
    assert (view["stature_m"], view["joints_m"]) == (own.stature_m, own.joints_m.tolist())
    assert view["part_from_node"] == own.part_from_node.reshape(-1, 16).tolist()
    error(analyst.get(f"{PATH}/{HASH}/binding"), 404, "not_found")


def test_a_body_that_nothing_refers_to_is_deleted_with_its_file(fresh_lab: Lab) -> None:
    """An uploaded body without a name is deleted with its file, and can be uploaded again."""
    before = counted(fresh_lab)
    upload(fresh_lab)
    assert fresh_lab.operator.delete(f"{PATH}/{HASH}").status_code == 204
    assert counted(fresh_lab) == before
    error(fresh_lab.operator.get(f"{PATH}/{HASH}/file"), 404, "not_found")
    error(fresh_lab.operator.delete(f"{PATH}/{HASH}"), 404, "not_found")
    newest = ok(fresh_lab.operator.get("/api/audit"))["entries"][0]
    assert (newest["action"], newest["details"]) == ("humanoid.removed", {"content": HASH[:12]})
    assert upload(fresh_lab).status_code == 201


def test_a_body_that_something_refers_to_stays(fresh_lab: Lab) -> None:
    """Shipped bodies, named ones, and those of a configuration or a tuning are not deleted."""

    def refused(content_hash: str = HASH) -> str:
        answer = fresh_lab.operator.delete(f"{PATH}/{content_hash}")
        message: str = error(answer, 409, "conflict")["message"]
        return message

    shipped = ok(fresh_lab.operator.get(PATH))["humanoids"][0]["content_hash"]
    assert "comes with Reembody" in refused(shipped)
    upload(fresh_lab)
    worn = replace(SHIPPED, humanoid=HASH)
    asked = {"configuration": as_json(worn), "options": {"axes": ["NeckX"]}}
    tuning = ok(fresh_lab.operator.post("/api/avatar-tunings", json=asked))["id"]
    assert "a tuning of an avatar uses" in refused()
    fresh_lab.operator.post(f"/api/avatar-tunings/{tuning}/stop")
    new(fresh_lab, "worn", worn)
    assert "use this body: worn, version 1" in refused()
    ok(fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": "tall"}))
    assert "called 'tall'" in refused()
    assert ok(fresh_lab.operator.get(f"{PATH}/{HASH}"))["name"] == "tall"
