"""Tests of bodies: named once, confirmed where their licence asks for it, checked, and worn."""

import math
from dataclasses import replace

import pytest
from sqlalchemy import update

from app.adapters.humanoids import ModelRights, read_humanoid
from app.features.movement.humanoids.checks import attention_of, checks_of, reach_off_m
from app.features.movement.humanoids.licences import asked_terms, stored_licence
from app.features.movement.humanoids.service import parsed_figure
from app.features.results.analysis.material import OWN_BODY
from app.models import HumanoidRow
from app.protocol.humanoid import figure_json
from app.science.avatar.body import figure_of, proportions
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.avatar.test_avatars import PATH as AVATARS
from tests.features.movement.avatar.test_avatars import SHIPPED, as_json, new
from tests.features.movement.avatar.test_studies import KEY, study
from tests.features.movement.humanoids.test_humanoids import FOUR, HASH, PATH, upload
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import Model

STRICT = stored_licence(ModelRights(title="Strict", authors=("A. Author",), wearers="author"))


def change(lab: Lab, content_hash: str = HASH, **fields: object) -> Json:
    """Change a body and return it."""
    view: Json = ok(lab.operator.patch(f"{PATH}/{content_hash}", json=fields))
    return view


def set_columns(lab: Lab, content_hash: str = HASH, **values: object) -> None:
    """Set columns of a body, as another release or another file would have."""
    with lab.database.writing() as db:
        db.execute(update(HumanoidRow).where(HumanoidRow.hash == content_hash).values(**values))


def test_a_body_gets_its_name_once(fresh_lab: Lab) -> None:
    """A name is given once, to one body only, and is recorded with the hash of the body's file."""
    upload(fresh_lab)
    other = upload(fresh_lab, FOUR, "four.vrm").json()["content_hash"]
    assert change(fresh_lab, name="tall", title="The tall one")["name"] == "tall"
    entries = ok(fresh_lab.operator.get("/api/audit"))["entries"]
    assert [one["action"] for one in entries[:2]] == ["humanoid.titled", "humanoid.named"]
    assert entries[1]["details"] == {"content": HASH[:12], "name": "tall"}
    again = fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": "short"})
    assert error(again, 409, "conflict")["valid"] == "tall"
    taken = fresh_lab.operator.patch(f"{PATH}/{other}", json={"name": "tall", "title": "Mine"})
    assert "another body is called 'tall'" in error(taken, 409, "conflict")["message"]
    listed = {one["content_hash"]: one for one in ok(fresh_lab.operator.get(PATH))["humanoids"]}
    assert (listed[HASH]["name"], listed[HASH]["title"]) == ("tall", "The tall one")
    assert (listed[other]["name"], listed[other]["title"]) == (None, None)
    assert change(fresh_lab, name="tall", title="Tall")["title"] == "Tall"


@pytest.mark.one_engine
def test_names_of_bodies_are_keys(fresh_lab: Lab) -> None:
    """A name with capitals, spaces or too many letters is refused; unknown bodies have no name."""
    upload(fresh_lab)
    for name in ("Tall", "a b", "", "1st", "x" * 81):
        answer = fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": name})
        error(answer, 422, "invalid_input")
    error(fresh_lab.operator.patch(f"{PATH}/{'0' * 64}", json={"name": "tall"}), 404, "not_found")


@pytest.mark.one_engine
def test_the_word_for_the_body_of_a_configuration_is_no_name(fresh_lab: Lab) -> None:
    """A body cannot have the name by which results call the body of a study's configuration."""
    upload(fresh_lab)
    answer = fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": OWN_BODY})
    assert "Choose another name" in error(answer, 422, "invalid_input")["remedy"]
    assert ok(fresh_lab.operator.get(f"{PATH}/{HASH}"))["name"] is None


@pytest.mark.one_engine
def test_a_body_whose_licence_was_never_read_is_measured_again_first(fresh_lab: Lab) -> None:
    """A body of an earlier release gets neither a name nor a configuration before it is measured.

    Configurations that are stored already stay as they are.
    """
    upload(fresh_lab)
    configuration = replace(SHIPPED, humanoid=HASH)
    new(fresh_lab, "earlier", configuration)
    set_columns(fresh_lab, licence=None)
    named = fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": "old"})
    assert "Measure it again" in error(named, 409, "conflict")["remedy"]
    body = {
        "key": "skinned",
        "title": "Skinned",
        "origin": "by_hand",
        "configuration": as_json(configuration),
    }
    worn = error(fresh_lab.operator.post(AVATARS, json=body), 422, "invalid_config")
    assert worn["details"][0]["path"] == "configuration.humanoid"
    assert "Measure it again" in worn["details"][0]["remedy"]
    stored = ok(fresh_lab.operator.get(f"{AVATARS}/earlier"))["newest"]
    assert stored["configuration"]["humanoid"] == HASH
    ok(fresh_lab.operator.post(f"{PATH}/{HASH}/measure"))
    assert change(fresh_lab, name="old")["name"] == "old"
    assert fresh_lab.operator.post(AVATARS, json=body).status_code == 201


@pytest.mark.one_engine
def test_a_licence_that_restricts_wearing_must_be_confirmed(fresh_lab: Lab) -> None:
    """A body that only its author may wear is named and configured only after a confirmation.

    Who confirmed it, and when, is with the body and in the audit trail.
    """
    upload(fresh_lab)
    set_columns(fresh_lab, licence=STRICT)
    assert ok(fresh_lab.operator.get(f"{PATH}/{HASH}"))["asked"] == ["only_author"]
    refusal = error(
        fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": "strict"}), 409, "conflict"
    )
    assert refusal["valid"] == ["only_author"]
    body = {
        "key": "skinned",
        "title": "Skinned",
        "origin": "by_hand",
        "configuration": as_json(replace(SHIPPED, humanoid=HASH)),
    }
    worn = error(fresh_lab.operator.post(AVATARS, json=body), 422, "invalid_config")
    assert worn["details"][0]["path"] == "configuration.humanoid"
    not_asked = {"name": "strict", "confirmed": ["only_licensed_people"]}
    refusal = error(
        fresh_lab.operator.patch(f"{PATH}/{HASH}", json=not_asked), 422, "invalid_input"
    )
    assert (refusal["value"], refusal["valid"]) == ("only_licensed_people", ["only_author"])
    view = change(fresh_lab, name="strict", confirmed=["only_author"])
    assert (view["name"], view["asked"]) == ("strict", [])
    assert [one["term"] for one in view["confirmations"]] == ["only_author"]
    assert view["confirmations"][0]["by"] == "account:admin"
    entries = ok(fresh_lab.operator.get("/api/audit"))["entries"]
    assert [one["action"] for one in entries[:2]] == ["humanoid.named", "humanoid.confirmed"]
    assert entries[1]["details"]["terms"] == ["only_author"]
    assert fresh_lab.operator.post(AVATARS, json=body).status_code == 201


@pytest.mark.one_engine
@pytest.mark.parametrize("name", ["null", "nan", "true", "no", OWN_BODY])
def test_words_that_files_read_otherwise_are_no_names(fresh_lab: Lab, name: str) -> None:
    """A name that YAML or a table reads as nothing or as yes or no is refused."""
    upload(fresh_lab)
    refusal = error(
        fresh_lab.operator.patch(f"{PATH}/{HASH}", json={"name": name}), 422, "invalid_input"
    )
    assert refusal["value"] == name
    title = {"title": "a\u202egpj.glb"}
    refused = error(fresh_lab.operator.patch(f"{PATH}/{HASH}", json=title), 422, "invalid_input")
    assert "Character 2 is U+202E" in refused["details"][0]["message"]


@pytest.mark.one_engine
def test_a_body_is_checked(fresh_lab: Lab) -> None:
    """The checks name absent fingers, and say of old measurements that triangles are unknown."""
    four = upload(fresh_lab, FOUR, "four.vrm").json()["content_hash"]
    set_columns(fresh_lab, four, triangles=None, licence=None)
    checks = {one["key"]: one for one in ok(fresh_lab.operator.get(f"{PATH}/{four}"))["checks"]}
    assert (checks["fingers"]["status"], checks["fingers"]["value"]) == ("note", 8.0)
    assert "LeftLittleProximal" in checks["fingers"]["parts"]
    assert checks["triangles"] == {**checks["triangles"], "status": "unknown", "value": None}
    assert (checks["parts"]["status"], checks["licence"]["status"]) == ("good", "unknown")
    set_columns(fresh_lab, four, triangles=20_001)
    checks = {one["key"]: one for one in ok(fresh_lab.operator.get(f"{PATH}/{four}"))["checks"]}
    assert (checks["triangles"]["status"], checks["triangles"]["value"]) == ("warn", 20_001.0)


@pytest.mark.one_engine
def test_the_list_says_what_asks_for_attention(fresh_lab: Lab) -> None:
    """The list names too many triangles, open terms of a licence and a hand that misses a box."""
    own = upload(fresh_lab).json()["content_hash"]
    view = ok(fresh_lab.operator.get(f"{PATH}/{own}"))
    # Arms of 93 % of 0.564 m, and shoulders 2 cm further back: the hand is as much nearer.
    assert view["reach_off_m"] == pytest.approx(0.07 * 0.564 + 0.02, abs=0.002)
    assert view["attention"] == []
    figure = figure_of(read_humanoid(humanoid_file()).humanoid)
    narrow = {
        part: (0.3 * x if "Arm" in part or part.endswith("Hand") else x, y, z)
        for part, (x, y, z) in figure.places_m.items()
    }
    short = figure_json(replace(figure, places_m=narrow))
    set_columns(fresh_lab, own, figure=short, triangles=20_001, licence=STRICT)
    with fresh_lab.database.reading() as db:
        assert reach_off_m(parsed_figure(short)) == pytest.approx(0.45, abs=0.05)
        row = db.get_one(HumanoidRow, own)
        checks = {one.key: one for one in checks_of(row, parsed_figure(short))}
        asked = [key for key, one in checks.items() if one.status == "warn"]
        found = attention_of(row.triangles, reach_off_m(parsed_figure(short)), asked_terms(row))
    assert asked == found == ["reach", "triangles", "wearing"]
    arm, *others = checks["reach"].lengths
    assert arm.name == "arm"
    assert (arm.length_m, arm.usual_m) == pytest.approx((0.3 * 0.93 * 0.564, 0.564), abs=0.002)
    assert [one.name for one in others] == ["shoulders"]


def test_unusual_proportions_are_named_with_their_usual_range() -> None:
    """Forearms of 55 % of the usual length are told with what people of that stature have."""

    def shortened(document: Json) -> None:
        for node in document["nodes"]:
            if node.get("name") in {"LeftHand", "RightHand"}:
                node["matrix"][12:15] = [0.55 * one for one in node["matrix"][12:15]]

    usual = HumanoidRow(figure={}, triangles=None, licence=None)
    figure = figure_of(read_humanoid(humanoid_file(Model(edit=shortened))).humanoid)
    check = {one.key: one for one in checks_of(usual, figure)}["proportions"]
    (found,) = check.lengths
    person_m = proportions(figure.stature_m).segments_m["forearm"]
    assert (check.status, found.name, check.stature_m) == ("note", "forearm", figure.stature_m)
    assert found.length_m == pytest.approx(0.55 * 0.93 * person_m, rel=1e-3)
    assert found.usual_m == person_m
    assert (found.low_m, found.high_m) == pytest.approx((0.7 * person_m, 1.3 * person_m))
    even = {
        one.key: one for one in checks_of(usual, figure_of(read_humanoid(humanoid_file()).humanoid))
    }
    assert (even["proportions"].status, even["proportions"].lengths) == ("good", [])


@pytest.mark.one_engine
def test_a_rest_pose_with_lowered_arms_is_mentioned(fresh_lab: Lab) -> None:
    """The checks say how far the arms of a model in an A-pose were turned into the T-pose."""
    lowered = humanoid_file(Model(arms_down_rad=math.radians(40.0)))
    view = upload(fresh_lab, lowered, "a-pose.glb").json()
    checks = {one["key"]: one for one in view["checks"]}
    assert checks["rest_pose"]["status"] == "note"
    assert checks["rest_pose"]["notes"] == ["The arms were turned by 40 degrees into the T-pose."]
    upright = {one["key"]: one for one in upload(fresh_lab).json()["checks"]}
    assert upright["rest_pose"]["status"] == "good"


@pytest.mark.one_engine
def test_who_wears_a_body(fresh_lab: Lab) -> None:
    """Configurations and studies that wear a body are listed; blinded ones not for operators."""
    upload(fresh_lab)
    change(fresh_lab, name="tall")
    new(fresh_lab, "skinned", replace(SHIPPED, humanoid=HASH))
    text = study("{key: standard, version: 1}")
    text = text.replace("key: latency_125\n", "key: latency_125\n    body: tall\n")
    text = text.replace("operator: false", "operator: true")
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": text}))
    worn = ok(fresh_lab.operator.get(f"{PATH}/{HASH}/use"))
    assert worn["configurations"] == [{"key": "skinned", "title": "Soft neck", "version": 1}]
    assert [(one["key"], one["version"]) for one in worn["studies"]] == [(KEY, 1)]
    assert ok(sign_in(fresh_lab, "operator").get(f"{PATH}/{HASH}/use"))["studies"] == []
    unknown = text.replace("body: tall", "body: small").replace(f"key: {KEY}", "key: other")
    refusal = error(
        fresh_lab.operator.post("/api/studies", json={"yaml": unknown}), 422, "invalid_config"
    )
    assert refusal["details"][0]["valid"] == ["female", "male", "neutral", "tall"]


@pytest.mark.one_engine
def test_a_body_is_measured_again(fresh_lab: Lab) -> None:
    """A body that an earlier release has measured gets its counts; its figure does not change."""
    before = upload(fresh_lab).json()
    set_columns(fresh_lab, triangles=None, vertices=None, textures=None, licence=None)
    after = ok(fresh_lab.operator.post(f"{PATH}/{HASH}/measure"))
    assert after == before
    assert after["triangles"] > 0
    assert after["licence"]["wearers"] == "unknown"
    error(fresh_lab.operator.post(f"{PATH}/{'0' * 64}/measure"), 404, "not_found")
