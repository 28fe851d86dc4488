"""Tests of listing, uploading, validating and deleting scenes."""

import pytest

from tests.features.lab import Lab, error, ok

HALL = """key: hall
title: A hall
bounds_m: [-2, -2, 2, 4]
obstacles:
  - {shape: box, name: table, center_m: [0, 1], size_m: [1.2, 0.6]}
places: {start: [0, -1], goal: [0, 3]}
paths:
  - {name: there, from: start, to: goal}
"""


def test_shipped_scenes_are_listed_and_cannot_be_deleted(walking_lab: Lab) -> None:
    """Both workplaces of the paper are listed with their paths and cannot be deleted."""
    calls = walking_lab.operator
    listed = ok(calls.get("/api/walking/scenes"))
    paths = {
        one["key"]: len(ok(calls.get(f"/api/walking/scenes/{one['key']}"))["paths"])
        for one in listed
        if one["shipped"]
    }
    assert paths == {"car-and-three-racks": 11, "car-between-two-racks": 6}
    error(calls.delete("/api/walking/scenes/car-and-three-racks"), 409, "conflict")


def test_a_scene_is_uploaded_once_and_can_be_deleted(walking_lab: Lab) -> None:
    """An uploaded scene downloads unchanged, its key is unique, and it can be deleted."""
    calls = walking_lab.operator
    made = ok(calls.post("/api/walking/scenes", json={"text": HALL}))
    assert made["obstacles"][0]["name"] == "table"
    assert calls.get("/api/walking/scenes/hall/file").text == HALL
    error(calls.post("/api/walking/scenes", json={"text": HALL}), 409, "conflict")
    ok(calls.delete("/api/walking/scenes/hall"))
    error(calls.get("/api/walking/scenes/hall"), 404, "not_found")


@pytest.mark.one_engine
def test_every_problem_of_a_scene_is_reported(walking_lab: Lab) -> None:
    """Every problem of a scene is reported with its line, and the scene is not stored."""
    broken = HALL.replace("goal: [0, 3]", "goal: [0, 1]").replace("from: start", "from: nowhere")
    refusal = error(
        walking_lab.operator.post("/api/walking/scenes", json={"text": broken}),
        422,
        "invalid_config",
    )
    assert [one["line"] for one in refusal["details"]] == [6, 8]
    assert "inside obstacle 'table'" in refusal["details"][0]["message"]
    error(walking_lab.operator.get("/api/walking/scenes/hall"), 404, "not_found")
