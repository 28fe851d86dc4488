"""Tests of walks in several scenes, and of models that depend on further numbers, over HTTP."""

import itertools
from pathlib import Path

import pytest

from app.features.movement.walking.sources import Store, TrackSource
from app.features.movement.walking.worker_tasks import captured_table
from app.models import WalkSetRow
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.captures.files import uploaded, walk_bvh
from tests.features.movement.walking.test_captured import captured_walk, store_content
from tests.features.movement.walking.walkers import (
    SMALL,
    fitted,
    load_of,
    scene_of,
    settled,
    upload_tracks,
    with_columns,
)

HALL = """key: KEY
title: A hall of KEY
bounds_m: [-2, -2, 4, 8]
"""
RACKS = "car-and-three-racks"


def add_hall(lab: Lab, key: str, more: str = "", bounds: str = "-2, -2, 4, 8") -> None:
    """Add a scene without obstacles."""
    text = HALL.replace("KEY", key).replace("-2, -2, 4, 8", bounds) + more
    ok(lab.operator.post("/api/walking/scenes", json={"text": text}))


@pytest.fixture(scope="module")
def walks(walking_lab: Lab) -> Json:
    """Return a set of walks with scenes and loads."""
    add_hall(walking_lab, "hall-a")
    beat = itertools.cycle("01")
    data = with_columns(
        scene=scene_of, load_kg=load_of, note=lambda *_: "x", beat=lambda *_: next(beat)
    )
    made: Json = ok(upload_tracks(walking_lab, data))
    return made


@pytest.fixture(scope="module")
def model(walking_lab: Lab, walks: Json) -> Json:
    """Return a model of these walks that depends on the load."""
    return fitted(walking_lab, walks["id"], depends_on=["load_kg"])


def test_a_set_says_where_its_walks_were_and_with_which_numbers(walks: Json) -> None:
    """The summary counts walks by scene, and has the range of each number of walks."""
    summary = walks["summary"]
    assert summary["scenes"] == [
        {"key": None, "walks": 5},
        {"key": "hall-a", "walks": 2},
        {"key": "open floor", "walks": 2},
    ]
    load = summary["numbers"]["load_kg"]
    assert (load["walks"], load["people"], load["range"]["high"]) == (9, 3, 4.0)
    assert (list(summary["numbers"]), summary["changing_numbers"]) == (["load_kg"], ["beat"])
    assert set(summary["dependencies"]) == {"length_m", "turning_per_m"}
    assert walks["origin"]["reads_columns"]


def test_a_model_names_its_scenes_and_its_numbers(model: Json) -> None:
    """A fitted model shows how many walks were in which scene, and depends on the number chosen."""
    assert model["state"] == "ready", model["trouble"]
    scenes = {one["key"]: (one["title"], one["walks"]) for one in model["walk_set"]["scenes"]}
    assert scenes == {
        None: ("", 5),
        "hall-a": ("A hall of hall-a", 2),
        "open floor": ("open floor", 2),
    }
    summary = model["summary"]
    assert list(summary["dependencies"]) == ["length_m", "turning_per_m", "load_kg"]
    assert summary["dependencies"]["load_kg"]["high"] == 4.0
    assert [one["method"] for one in summary["predicted"]][-1] == "mixed without load_kg"
    assert model["options"]["depends_on"] == ["load_kg"]


@pytest.mark.one_engine
def test_a_prediction_takes_a_number_or_the_mean(walking_lab: Lab, model: Json) -> None:
    """Without the number the mean is assumed and said; beyond the walks' range that is said."""
    path = f"/api/walking/models/{model['id']}/prediction"
    query = {"points_m": [[0, 0], [0, 1.9]], "count": 60}
    mean = ok(walking_lab.operator.post(path, json=query))
    assert mean["assumed"] == ["load_kg"]
    assert 0.0 < mean["dependencies"]["load_kg"] < 4.0
    given = ok(walking_lab.operator.post(path, json=query | {"others": {"load_kg": 9.0}}))
    assert (given["assumed"], given["outside"]) == ([], ["load_kg"])
    assert given["dependencies"]["load_kg"] == 9.0
    refusal = error(
        walking_lab.operator.post(path, json=query | {"others": {"mood": 1}}), 422, "invalid_input"
    )
    assert "does not depend on 'mood'" in refusal["message"]
    assert "load_kg" in refusal["remedy"]
    far = query | {"others": {"load_kg": 1e6}}
    refusal = error(walking_lab.operator.post(path, json=far), 422, "invalid_input")
    assert "load_kg is 1e+06, and the model has seen 0.00 to 4.00" in refusal["message"]
    assert "nearer to those" in refusal["remedy"]
    piece = {"dependencies": given["dependencies"], "held": "acceleration", "value": 0.7}
    ok(walking_lab.operator.post(f"/api/walking/models/{model['id']}/slice", json=piece))


@pytest.mark.one_engine
def test_a_number_that_cannot_be_learnt_from_is_refused(walking_lab: Lab, walks: Json) -> None:
    """A number that there is not, that few walks have, that is constant or badly named: refused."""
    data = with_columns(
        load_kg=load_of,
        pack_kg=lambda *_: "5",
        rare=lambda person, _: "1" if person == "P0" else "",
        typo=lambda _, walk: "2 kg" if walk == 3 else "2",
    )
    other = ok(upload_tracks(walking_lab, data))
    assert "column typo contains '2 kg'" in other["summary"]["spoilt_numbers"][0]
    for name, told in (
        ("mood", "have no number 'mood'"),
        ("rare", "rare is known for 3 of 9 walks only"),
        ("pack_kg", "the same for all walks"),
    ):
        request = {"title": "No", "walk_set_id": other["id"], "options": {"depends_on": [name]}}
        refusal = error(
            walking_lab.operator.post("/api/walking/models", json=request), 422, "invalid_input"
        )
        assert told in refusal["message"]
        assert refusal["valid"] == ["load_kg"]
    request = {"title": "No", "walk_set_id": walks["id"], "options": {"depends_on": ["stature"]}}
    refused = walking_lab.operator.post("/api/walking/models", json=request)
    assert "The name 'stature' is taken" in refused.text
    request["options"] = {"depends_on": ["load_kg", "load_kg"]}
    refused = walking_lab.operator.post("/api/walking/models", json=request)
    assert refused.status_code == 422
    assert "load_kg, load_kg: up to 3 are valid, each once" in refused.text


@pytest.mark.one_engine
def test_walks_without_the_number_are_left_out_by_name(walking_lab: Lab) -> None:
    """A walk during which the number changes is left out of the model, and the model says so."""
    data = with_columns(load_kg=lambda person, _: person[1])
    lines = data.decode().splitlines()
    # Amid the second of three walks of the second of three people.
    amid = len(lines) // 2
    assert lines[amid].endswith(",1")
    lines[amid] = f"{lines[amid][:-1]}3"
    data = "\n".join(lines).encode()
    walks = ok(upload_tracks(walking_lab, data))
    model = fitted(walking_lab, walks["id"], depends_on=["load_kg"])
    assert model["summary"]["walks"] == 8
    assert model["summary"]["scenes"] == [{"key": None, "walks": 8}]
    (left_out,) = model["summary"]["left_out_walks"]
    assert left_out["walk"] == "walk 5, of P1 (tracks.csv)"
    assert "load_kg changes from 1 to 3 during it" in left_out["reason"]


@pytest.mark.one_engine
def test_an_unknown_scene_of_a_table_is_refused_at_its_line(walking_lab: Lab) -> None:
    """A scene that there is not is refused with line, value, and the scenes that there are."""
    data = with_columns(scene=lambda person, _: "cellar" if person == "P2" else "")
    line = next(at for at, row in enumerate(data.decode().splitlines(), 1) if "cellar" in row)
    refusal = error(upload_tracks(walking_lab, data), 422, "invalid_input")
    assert f"tracks.csv, line {line}: there is no scene 'cellar'" in refusal["message"]
    assert RACKS in refusal["message"]
    assert "add the scene's file first" in refusal["remedy"]
    origin = {"kind": "captures", "captures": [
        {"capture_id": "0" * 32, "subject": "Ann", "scene": "cellar"}]}  # fmt: skip
    request = {"title": "Captured", "origin": origin}
    refusal = error(
        walking_lab.operator.post("/api/walking/walk-sets", json=request), 422, "invalid_input"
    )
    assert "capture 1 of the set, of Ann" in refusal["message"]
    assert (refusal["value"], RACKS in refusal["valid"]) == ("cellar", True)


def test_captures_carry_scenes_and_numbers(database_url: str, tmp_path: Path) -> None:
    """Walks cut from captures are planned in the scene of their capture and have its numbers."""
    content = store_content(database_url, walk_bvh(150), tmp_path)
    source = TrackSource(
        "captures",
        "",
        subjects=(("c0", "Ann"),),
        scenes=(("hall", HALL.replace("KEY", "hall").replace("-2, -2, 4, 8", "-9, -9, 9, 9")),),
        walked_in=(("c0", "hall"),),
        numbers=(("c0", (("load_kg", 4.0),)),),
    )
    found = captured_table(Store(database_url), (("c0", captured_walk(content)),), source)
    assert found.summary["scenes"] == [{"key": "hall", "walks": 1}]
    assert found.summary["numbers"]["load_kg"]["range"]["mean"] == 4.0


@pytest.mark.one_engine
def test_a_set_of_captures_says_where_each_was_walked(walking_lab: Lab) -> None:
    """Scene and numbers that are given for a capture are those of its walks; names are checked."""
    calls = walking_lab.operator
    add_hall(walking_lab, "hall-c", "clearance_m: 0.1\n", bounds="-9, -9, 9, 9")
    capture = uploaded(calls, walk_bvh(150))
    own = {"capture_id": capture["id"], "subject": "Ann"}
    told = own | {"scene": "hall-c", "numbers": {"load_kg": 6.5, "gaze_on_display": 1}}
    request = {"title": "Captured", "origin": {"kind": "captures", "captures": [told]}}
    walks = ok(calls.post("/api/walking/walk-sets", json=request))
    assert walks["summary"]["scenes"] == [{"key": "hall-c", "walks": 1}]
    assert walks["summary"]["numbers"]["load_kg"]["range"]["low"] == 6.5
    assert walks["origin"]["captures"][0]["scene"] == "hall-c"
    for name, expected in (("stature_m", "is taken"), ("load (kg)", "pattern")):
        request["origin"] = {"kind": "captures", "captures": [own | {"numbers": {name: 1}}]}
        refused = calls.post("/api/walking/walk-sets", json=request)
        assert refused.status_code == 422
        assert expected in refused.text


def test_a_scene_that_changed_or_is_gone_stops_a_resumed_fit(walking_lab: Lab) -> None:
    """Scenes are kept by their hash: a fit does not go on with another floor, or without it."""
    calls = walking_lab.operator
    add_hall(walking_lab, "hall-b")
    walks = ok(upload_tracks(walking_lab, with_columns(scene=lambda *_: "hall-b")))
    request = {"title": "Stopped", "walk_set_id": walks["id"], "options": SMALL}
    model = ok(calls.post("/api/walking/models", json=request))
    path = f"/api/walking/models/{model['id']}"
    if ok(calls.get(path))["state"] == "fitting":
        ok(calls.post(f"{path}/stop"))
    ok(calls.delete("/api/walking/scenes/hall-b"))
    gone = error(calls.post(f"{path}/resume"), 409, "conflict")
    assert "'hall-b', which was deleted" in gone["message"]
    assert "Add a scene with this key again" in gone["remedy"]
    refused = error(calls.post("/api/walking/models", json=request), 409, "conflict")
    assert "'hall-b', which was deleted" in refused["message"]
    add_hall(walking_lab, "hall-b", "clearance_m: 0.3\n")
    changed = error(calls.post(f"{path}/resume"), 409, "conflict")
    assert "has changed since the fit was ordered" in changed["message"]
    assert changed["value"] == "hall-b"
    ok(calls.delete("/api/walking/scenes/hall-b"))
    add_hall(walking_lab, "hall-b")
    ok(calls.post(f"{path}/resume"))
    assert settled(walking_lab, model["id"])["state"] == "ready"
    # The model does not need its scene any more; it still says which it was.
    ok(calls.delete("/api/walking/scenes/hall-b"))
    (scene,) = ok(calls.get(path))["walk_set"]["scenes"]
    assert (scene["key"], scene["title"], scene["walks"]) == ("hall-b", "A hall of hall-b", 9)


def test_a_set_that_was_stored_earlier_is_read_as_it_was(walking_lab: Lab) -> None:
    """A stored table whose column `scene` did not count then is fitted as before."""
    add_hall(walking_lab, "hall-of-old")
    walks = ok(
        upload_tracks(walking_lab, with_columns(scene=lambda *_: "hall-of-old", load_kg=load_of))
    )
    with walking_lab.database.writing() as db:
        row = db.get(WalkSetRow, walks["id"])
        assert row is not None
        row.origin = {key: one for key, one in row.origin.items() if key != "reads_columns"}
        added = ("scenes", "numbers", "changing_numbers", "spoilt_numbers")
        row.summary = {key: one for key, one in row.summary.items() if key not in added}
    listed = ok(walking_lab.operator.get(f"/api/walking/walk-sets/{walks['id']}"))
    assert (listed["summary"]["scenes"], listed["summary"]["numbers"]) == ([], {})
    model = fitted(walking_lab, walks["id"])
    assert model["state"] == "ready", model["trouble"]
    assert model["walk_set"]["scenes"] == []
    assert model["summary"]["walks"] == 9
