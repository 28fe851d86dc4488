"""Tables of tracks, small models and a scene for tests."""

import csv
import io
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from tests.features.lab import Json, Lab, ok

SMALL = {"steps": 3, "k": 5, "entries": 30, "reading": "time-aware", "seed": 1}
"""Options of a model that is fitted within a second."""


FLOOR = """key: floor
title: An open floor
bounds_m: [-2, -2, 4, 4]
places: {start: [0, -1], middle: [0.5, 1], goal: [2, 3]}
paths:
  - {name: there, from: start, to: goal}
  - {name: half, from: start, to: middle}
  - {name: rest, from: middle, to: goal}
"""
"""A scene without obstacles, so that planning takes no time."""


def table(people: int = 3, walks: int = 3, bad_line: int | None = None) -> bytes:
    """Return minimum-jerk walks back and forth along y; each person has their own pace."""
    lines = ["id,time_s,x_m,y_m"]
    for person in range(people):
        now_s, at_m = 0.0, 0.0
        for walk in range(walks):
            goal_m = 0.0 if at_m > 0.0 else 1.5 + 0.5 * walk
            for share in np.linspace(0.0, 1.0, 61):
                way = 10 * share**3 - 15 * share**4 + 6 * share**5
                lines.append(f"P{person},{now_s:.4f},0.0,{at_m + way * (goal_m - at_m):.5f}")
                now_s += (2.0 + 0.2 * person + 0.3 * walk) / 60.0
            at_m = goal_m
            for _ in range(40):
                lines.append(f"P{person},{now_s:.4f},0.0,{at_m:.5f}")
                now_s += 1.0 / 40.0
    if bad_line is not None:
        lines[bad_line - 1] = "P0,0.5,nan,0.0"
    return "\n".join(lines).encode()


def with_columns(**columns: Callable[[str, int], str]) -> bytes:
    """Return the walkers' table with further columns, each a function of a row's person and walk.

    A row's walk is 1, 2 or 3, from amid the standing before it.
    """
    rows = list(csv.DictReader(io.StringIO(table().decode())))
    text = io.StringIO()
    writer = csv.DictWriter(text, [*rows[0], *columns])
    writer.writeheader()
    for row in rows:
        person, time_s = row["id"], float(row["time_s"])
        walk = 1 + sum(time_s > first_s + 0.2 * int(person[1]) * at
                       for at, first_s in ((1, 2.5), (2, 5.9)))  # fmt: skip
        writer.writerow(row | {name: of(person, walk) for name, of in columns.items()})
    return text.getvalue().encode()


def load_of(person: str, walk: int) -> str:
    """Return the load of a person, who puts it down before the third walk."""
    return str(2 * int(person[1])) if walk < 3 else "0"


def scene_of(person: str, walk: int) -> str:
    """Return the scene of a row: a hall for two walks of one person, then nothing is said."""
    return {"P0": "hall-a", "P1": "open floor"}.get(person, "") if walk < 3 else ""


def upload_tracks(lab: Lab, data: bytes, **query: Any) -> Any:
    """Upload a table of tracks and return the response."""
    request = {"name": "tracks.csv", "title": "Corridor", **query}
    return lab.operator.post("/api/walking/walk-sets/tracks", params=request, content=data)


def fitted(lab: Lab, set_id: str, **options: Any) -> Json:
    """Request a model of a walk set and return it once its fit has ended."""
    request = {"title": "A model", "walk_set_id": set_id, "options": SMALL | options}
    model: Json = ok(lab.operator.post("/api/walking/models", json=request))
    return settled(lab, model["id"])


def settled(lab: Lab, model_id: str) -> Json:
    """Wait until the fit of a model has ended, and return the model."""
    for _ in range(600):
        model: Json = ok(lab.operator.get(f"/api/walking/models/{model_id}"))
        if model["state"] != "fitting":
            return model
        time.sleep(0.05)
    raise AssertionError(f"still fitted: {model['progress']}")
