"""Tests of fitting walking models and querying them, and of refused inputs."""

import io
import threading

import numpy as np
import pytest
from sqlalchemy import func, select

from app.features.movement.walking.fit_queue import FitQueue
from app.models import CaptureContent, WalkSetRow
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.walking.walkers import (
    FLOOR,
    SMALL,
    fitted,
    settled,
    table,
    upload_tracks,
)

RACKS = "car-and-three-racks"


@pytest.fixture(scope="module")
def model(walking_lab: Lab) -> Json:
    """Return a small model fitted to generated walkers."""
    ok(walking_lab.operator.post("/api/walking/scenes", json={"text": FLOOR}))
    origin = {"kind": "population", "population": "students", "people": 3, "repetitions": 1}
    request = {"title": "Students", "origin": origin | {"scene": "floor"}}
    walks = ok(walking_lab.operator.post("/api/walking/walk-sets", json=request))
    return fitted(walking_lab, walks["id"])


def counted(lab: Lab) -> tuple[int, int]:
    """Return the numbers of walk sets and stored contents."""
    with lab.database.reading() as db:
        return (
            db.scalars(select(func.count()).select_from(WalkSetRow)).one(),
            db.scalars(select(func.count()).select_from(CaptureContent)).one(),
        )


def test_a_models_summary_states_its_data(walking_lab: Lab, model: Json) -> None:
    """A model's summary states that it is synthetic, its walks and people, and its hash."""
    assert (model["state"], model["kind"]) == ("ready", "synthetic")
    summary = model["summary"]
    assert (summary["walks"], summary["people"]) == (9, 3)
    assert sum(summary["census"]["counts"]) == 9
    assert set(summary["dependencies"]) == {"length_m", "turning_per_m", "stature_m"}
    assert set(summary["left_out"]) == {"neighbours", "nodes", "people"}
    methods = [one["method"] for one in summary["predicted"]]
    assert methods == ["mixed", "constant speed", "line", "log-log"]
    assert {(one["walks"], one["people"]) for one in summary["predicted"]} == {(9, 3)}
    # Three people are too few for an interval, as the command says.
    assert {tuple(one["crps_less_s"][1:]) for one in summary["predicted"]} == {(None, None)}
    assert all("3 people cannot say" in one["no_interval"] for one in summary["predicted"])
    path = f"/api/walking/models/{model['id']}"
    file = walking_lab.operator.get(f"{path}/file")
    assert f"walking-{summary['model_hash'][:12]}.npz" in file.headers["content-disposition"]
    with np.load(io.BytesIO(file.content)) as archive:
        assert summary["model_hash"] in archive["header"].tobytes().decode()


@pytest.mark.one_engine
def test_a_prediction_is_a_distribution_of_durations(walking_lab: Lab, model: Json) -> None:
    """A prediction for a path is a distribution of durations that depends only on the seed."""
    path = f"/api/walking/models/{model['id']}/prediction"
    query = {"scene": RACKS, "points_m": [[2.05, 2.05], [0, 0]], "planned": True, "count": 60}
    first, other = (
        ok(walking_lab.operator.post(path, json=query | {"seed": seed})) for seed in (1, 2)
    )
    assert first["durations_s"] == sorted(first["durations_s"])
    assert len(first["durations_s"]) == 60
    assert first["durations_s"] != other["durations_s"]
    assert first["kinds"] == ["synthetic"]
    assert first["model"] == "mixed"
    assert first["assumed"] == ["stature_m"]
    assert list(first["quantiles_s"].values()) == sorted(first["quantiles_s"].values())
    for walker in first["walkers"]:
        # Within the radius of arrival plus two time steps at 2 m/s.
        assert np.hypot(*walker["xy_m"][-1]) < 0.05 + 2 * 2.0 / 60.0
    assert (first["stat"], first["adapt"]) == (other["stat"], other["adapt"])


@pytest.mark.one_engine
def test_a_slice_is_part_of_the_map(walking_lab: Lab, model: Json) -> None:
    """A slice of the model has values within the map's range; an unknown axis is refused."""
    path = f"/api/walking/models/{model['id']}/slice"
    query = {
        "dependencies": {"length_m": 2.0, "turning_per_m": 0.0, "stature_m": 1.8},
        "held": "acceleration",
        "value": 0.7,
    }
    found = ok(walking_lab.operator.post(path, json=query))
    assert (found["x"]["name"], found["y"]["name"]) == ("velocity", "angular")
    values = np.array(found["suitability"])
    assert values.shape == (3, 3)
    assert 0.0 <= values.min() <= values.max() <= found["largest"] + 1e-5
    refusal = error(
        walking_lab.operator.post(path, json=query | {"held": "mood"}), 422, "invalid_input"
    )
    assert "velocity, acceleration, angular" in refusal["remedy"]


@pytest.mark.one_engine
def test_impossible_paths_are_refused(walking_lab: Lab, model: Json) -> None:
    """A path through or into an obstacle, out of bounds or without length is refused."""
    path = f"/api/walking/models/{model['id']}/prediction"
    for points, planned, reported in (
        ([[0, 0], [0, 3]], False, "through obstacle 'rack 3'"),
        ([[0, 0], [0, 1.2]], True, "inside obstacle 'rack 3'"),
        ([[0, 0], [9, 0]], True, "outside the scene's bounds"),
        ([[0, 0], [0, 0]], True, "the same place"),
    ):
        query = {"scene": RACKS, "points_m": points, "planned": planned}
        refusal = error(walking_lab.operator.post(path, json=query), 422, "invalid_input")
        assert reported in refusal["message"]


def test_a_model_is_fitted_to_tracks_of_people(walking_lab: Lab) -> None:
    """A model fitted to an uploaded table of tracks is human; model and walks can be deleted."""
    walks = ok(upload_tracks(walking_lab, table(), stature=["P0=1.6", "P1=1.7", "P2=1.8"]))
    assert (walks["kind"], walks["summary"]["walks"], walks["summary"]["people"]) == ("human", 9, 3)
    model = fitted(walking_lab, walks["id"])
    assert (model["state"], model["kind"]) == ("ready", "human")
    calls = walking_lab.operator
    ok(calls.delete(f"/api/walking/walk-sets/{walks['id']}"))
    assert ok(calls.get(f"/api/walking/models/{model['id']}"))["walk_set"]["id"] is None
    ok(calls.delete(f"/api/walking/models/{model['id']}"))
    acts = [one["action"] for one in ok(calls.get("/api/audit"))["entries"]]
    assert {"walking.model_ordered", "walking.model_removed", "walking.walks_removed"} <= set(acts)


@pytest.mark.one_engine
def test_assumed_units_of_a_table_are_shown_and_doubted(walking_lab: Lab) -> None:
    """A table in feet without units is stored with what was assumed and why that is doubtful."""
    header, *lines = table().decode().splitlines()
    assert header == "id,time_s,x_m,y_m"
    cells = [line.split(",") for line in lines]
    feet = [f"{who},{t},{float(x) / 0.3048},{float(y) / 0.3048}" for who, t, x, y in cells]
    data = "\n".join(["id,time_s,x,y", *feet]).encode()
    summary = ok(upload_tracks(walking_lab, data))["summary"]
    assert summary["assumed"] == ["the columns x and y name no unit: taken as metres"]
    assert "times as fast as people usually walk" in summary["doubts"][0]
    said = ok(upload_tracks(walking_lab, table()))["summary"]
    assert (said["assumed"], said["doubts"]) == ([], [])


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (table(bad_line=9), "line 9"),
        (b"id,time_s,x_m,y_m\nA,0,0,0\n", "at least two"),
        (
            b"id,time_s,x_m,y_m\nA,0,0,0\nA,1,0,0\n",
            "there are no walks in 1 track(s): people stood still, within 0 m",
        ),
        (b"id,time_s,y_m\nA,0,0\n", "no column x"),
    ],
)
def test_an_invalid_table_of_tracks_is_refused(
    walking_lab: Lab, data: bytes, expected: str
) -> None:
    """An invalid table of tracks is refused with the reason, and nothing is stored."""
    before = counted(walking_lab)
    assert expected in error(upload_tracks(walking_lab, data), 422, "invalid_input")["message"]
    assert counted(walking_lab) == before


@pytest.mark.one_engine
def test_a_fit_needs_more_than_one_person(walking_lab: Lab) -> None:
    """Fitting a model to the walks of one person fails with the reason."""
    walks = ok(upload_tracks(walking_lab, table(people=1)))
    model = fitted(walking_lab, walks["id"])
    assert model["state"] == "failed"
    assert "all 3 walks are of one person, 'P0'" in model["trouble"]
    path = f"/api/walking/models/{model['id']}"
    error(walking_lab.operator.get(f"{path}/file"), 409, "not_now")
    error(walking_lab.operator.delete(f"/api/walking/walk-sets/{walks['id']}"), 409, "conflict")
    ok(walking_lab.operator.delete(path))


def test_a_fit_is_stopped_and_resumed(walking_lab: Lab) -> None:
    """A fit can be stopped once and then resumed once."""
    walks = ok(upload_tracks(walking_lab, table(people=2)))
    released = threading.Event()
    walking_lab.context.part(FitQueue)._maker.submit(released.wait)
    request = {"title": "Again", "walk_set_id": walks["id"], "options": SMALL}
    started = ok(walking_lab.operator.post("/api/walking/models", json=request))
    path = f"/api/walking/models/{started['id']}"
    assert started["progress"]["stage"] == "waiting"
    stopped = ok(walking_lab.operator.post(f"{path}/stop"))
    released.set()
    assert stopped["state"] == "stopped"
    error(walking_lab.operator.post(f"{path}/stop"), 409, "not_now")
    ok(walking_lab.operator.post(f"{path}/resume"))
    assert settled(walking_lab, started["id"])["state"] == "ready"
    error(walking_lab.operator.post(f"{path}/resume"), 409, "not_now")


@pytest.mark.one_engine
def test_a_model_of_the_paper_without_a_walk_leaves_the_prediction_there(walking_lab: Lab) -> None:
    """Where an agent of stat does not arrive, mixed still predicts, and the path is told as unlike.

    The walks that the model learns from are straight, and the path leads round a corner.
    """
    walks = ok(upload_tracks(walking_lab, table()))
    model = fitted(walking_lab, walks["id"])
    path = f"/api/walking/models/{model['id']}/prediction"
    query = {"points_m": [[0, 0], [0, 1.5], [1, 0.8]], "count": 20, "shown": 2}
    found = ok(walking_lab.operator.post(path, json=query))
    assert found["stat"] is None
    assert (found["model"], len(found["durations_s"])) == ("mixed", 20)
    assert "turning_per_m" in found["outside"]
