"""Tests of the body that a condition prescribes: ordered, built, recorded and exported by name."""

from itertools import permutations

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from app.features.record.sessions.contents import content_body, contents_of
from app.features.results.analysis.material import read_material
from app.features.results.analysis.schemas import FigureFilter
from app.models import Phase, StudySession
from tests.features.builders import SessionSpec, build_session
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.avatar.test_studies import KEY, study
from tests.features.movement.humanoids.test_humanoids import FIVE, FOUR
from tests.features.record.alarms.watched import order
from tests.features.record.headset.test_avatar import greet, request_avatar


def named(lab: Lab) -> dict[str, str]:
    """Store two bodies under names; return their hashes."""
    hashes = {}
    for name, file in (("five", FIVE), ("four", FOUR)):
        view = ok(lab.operator.post(f"/api/humanoids?name={name}.glb", content=file))
        hashes[name] = view["content_hash"]
        ok(lab.operator.patch(f"/api/humanoids/{hashes[name]}", json={"name": name}))
    return hashes


def bodies_study() -> str:
    """Return a study in which two conditions add no latency and differ in their bodies."""
    text = study("{key: standard, version: 1}")
    for old, name in (("0\n    latency_ms: 0", "five"), ("125\n    latency_ms: 125", "four")):
        assert f"latency_{old}" in text
        key = old.split("\n")[0]
        text = text.replace(
            f"latency_{old}", f"latency_{key}\n    latency_ms: 0\n    body: {name}", 1
        )
    return text


@pytest.fixture
def hashes(fresh_lab: Lab) -> dict[str, str]:
    """Provide a lab with two named bodies and a study that varies them."""
    found = named(fresh_lab)
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": bodies_study()}))
    return found


@pytest.mark.one_engine
def test_the_avatar_of_a_named_body_is_built_and_recorded(
    fresh_lab: Lab, hashes: dict[str, str]
) -> None:
    """The headset learns the study's bodies, and requests the avatar of each by name.

    Each is recorded once with the body's name and the hash of its model; a body that the study
    does not name is refused.
    """
    view: Json = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    token = fresh_lab.headset_token(view["id"])
    welcome = greet(fresh_lab.stranger(), token, {"avatars": ["physics"]})
    assert welcome["bodies"] == ["five", "four"]
    for body in ("five", "four", "five"):
        reply = ok(request_avatar(fresh_lab, token, {"stature_m": 1.7, "body": body}))
        assert (reply["body"], reply["humanoid"]) == (body, hashes[body])
        assert reply["configuration"]["humanoid"] == hashes[body]
        assert reply["configuration_hash"] == view["avatar_configuration_hash"]
    ok(request_avatar(fresh_lab, token, {"stature_m": 1.7}))
    built = [one for one in fresh_lab.events(view["id"]) if one["type"] == "avatar_built"]
    assert [one["data"].get("body") for one in built] == ["five", "four", None]
    with fresh_lab.database.reading() as db:
        recorded = [content_body(row) for row in contents_of(db, view["id"], "avatar")]
    assert [one.get("humanoid") for one in recorded if isinstance(one, dict)] == [
        hashes["five"],
        hashes["four"],
        None,
    ]
    wrong = request_avatar(fresh_lab, token, {"stature_m": 1.7, "body": "fifth"})
    assert error(wrong, 422, "invalid_input")["valid"] == ["five", "four"]
    # A body with a model of its own uses no measured lengths, and yet refuses impossible ones.
    for segments_m in ({"tail": 0.1}, {"thigh": 0.0001}):
        wish = {"stature_m": 1.7, "body": "five", "segments_m": segments_m}
        refusal = error(request_avatar(fresh_lab, token, wish), 422, "invalid_input")
        assert next(iter(segments_m)) in refusal["message"]


@pytest.mark.one_engine
def test_a_headset_fetches_the_bodies_of_its_own_session_only(
    fresh_lab: Lab, hashes: dict[str, str]
) -> None:
    """A headset gets file and binding of every body that its study names, in any order.

    A body of no condition, and one asked for by a headset of another study, are not found. The
    session's tablet gets none.
    """
    view: Json = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    headset = bearing(fresh_lab, view["id"])
    for name, file in (("four", FOUR), ("five", FIVE)):
        answer = headset.get(f"/api/vr/bodies/{hashes[name]}/file")
        assert (answer.status_code, answer.content) == (200, file)
        assert "max-age" in answer.headers["cache-control"]
        own = ok(headset.get(f"/api/vr/bodies/{hashes[name]}/binding"))
        assert own == ok(fresh_lab.operator.get(f"/api/humanoids/{hashes[name]}/binding"))
    error(headset.get(f"/api/vr/bodies/{'0' * 64}/file"), 404, "not_found")
    tablet = fresh_lab.tablet(view["id"])
    error(tablet.get(f"/api/vr/bodies/{hashes['four']}/file"), 401, "not_signed_in")
    error(tablet.post("/api/vr/avatar", json={"stature_m": 1.7}), 401, "not_signed_in")
    other = bearing(fresh_lab, fresh_lab.join()["id"])
    for what in ("file", "binding"):
        error(other.get(f"/api/vr/bodies/{hashes['four']}/{what}"), 404, "not_found")


def bearing(lab: Lab, session_id: str) -> TestClient:
    """Return a client with the token of the session's headset."""
    client = lab.stranger()
    client.headers["authorization"] = f"Bearer {lab.headset_token(session_id)}"
    return client


def test_an_order_without_a_body_is_what_it_was() -> None:
    """An order to wear the configuration's body has no field that older clients do not know."""
    assert "body" not in order().model_dump()
    assert order().model_copy(update={"body": "five"}).model_dump()["body"] == "five"


@pytest.mark.one_engine
def test_analysis_keeps_conditions_of_one_latency_apart(
    fresh_lab: Lab, hashes: dict[str, str]
) -> None:
    """Figures and tests are made of one body at a time where conditions share a latency.

    No phase of one body is among those of another, and together they are all.
    """
    with fresh_lab.database.writing() as db:
        build_session(db, SessionSpec("one", kind="people"), KEY)
        for phase in db.scalars(select(Phase).join(StudySession)):
            phase.body = {"latency_0": "five", "latency_125": "four"}.get(phase.condition or "")
    with fresh_lab.database.reading() as db:
        material = read_material(db, KEY, "people")
        assert material.bodies == ("five", "four", "configuration")
        assert material.with_body(FigureFilter()).body == "five"
        parts = {body: material.chosen(FigureFilter(body=body)).phases for body in material.bodies}
        blocks = material.phases.dropna(subset=["condition"])
        for body, rows in parts.items():
            own = rows.dropna(subset=["condition"])
            assert len(own) > 0
            assert set(own["body"].fillna("configuration")) == {body}
            assert own["condition"].nunique() == 1
        counted = sum(len(rows.dropna(subset=["condition"])) for rows in parts.values())
        assert counted == len(blocks)
        orders = set(material.sessions["order"])
        for name in ("scores", "answers", "contacts", "errors", "courses", "quality", "alarms"):
            assert material.of_body("four").tables[name] is not None
    assert orders <= {"latency_0 latency_125 latency_350"} or len(orders) == 1


@pytest.mark.one_engine
def test_orders_of_conditions_that_share_latencies_name_their_bodies(
    fresh_lab: Lab, hashes: dict[str, str]
) -> None:
    """Ledger and sessions tell orders apart by body, where latencies do not; blinding hides both.

    Six orders of three conditions, two of which add 0 ms, stay six rows of the ledger.
    """
    assert len(hashes) == 2
    ledger = f"/api/studies/{KEY}/ledger"
    client = fresh_lab.operator
    rows = ok(client.get(ledger))["sequences"]
    orders = {tuple(zip(row["sequence"], row["bodies"], strict=True)) for row in rows}
    assert orders == set(permutations(((0.0, "five"), (0.0, "four"), (350.0, None))))
    view: Json = ok(client.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    assert tuple(zip(view["sequence"], view["bodies"], strict=True)) in orders
    taken = ok(client.get(f"{ledger}?kind=test"))["slots"]
    assert [one["bodies"] for one in taken if one["attempts"]] == [view["bodies"]]
    timeline = {"yaml": bodies_study(), "slot": 0}
    assert set(ok(client.post("/api/studies/timeline", json=timeline))["bodies"]) == {
        "five",
        "four",
        None,
    }
    blinded = bodies_study().replace("operator: false", "operator: true")
    ok(client.post(f"/api/studies/{KEY}/versions", json={"yaml": blinded}))
    hidden: Json = ok(client.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    assert (hidden["sequence"], hidden["bodies"]) == (None, None)
    listed = ok(client.get(f"/api/studies/{KEY}/sessions"))
    assert [one["bodies"] for one in listed if one["id"] == hidden["id"]] == [None]
    found = ok(client.get(f"{ledger}?kind=test"))
    free = [one for one in found["slots"] if one["state"] == "free"]
    assert (found["sequences"], {one["bodies"] for one in free}) == (None, {None})
