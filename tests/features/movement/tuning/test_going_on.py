"""Tests that a tuning can be stopped and resumed, and survives the end of the server."""

import json
import threading
from pathlib import Path
from typing import Any

import pytest

from app.features.movement.tuning import TuningQueue
from app.features.movement.tuning.folder import TuningFolder
from app.features.movement.tuning.order import TunedBody, TuningOrder
from app.features.movement.tuning.schemas import TuningChoice
from app.features.movement.tuning.worker_tasks import run_tuning
from app.models import AvatarTuningRow
from app.protocol.avatar import loaded
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.tuning.tunings import ARM, PATH, begun, settled


def result_of(order: TuningOrder, folder: Path) -> Json:
    """Run a tuning in a folder and return its result without the times that it took."""
    folder.mkdir(exist_ok=True)
    found = run_tuning(order, folder)
    return {**found["report"], "wall_s": None, "configuration": found["canonical_json"]}


@pytest.mark.parametrize("lines", [0, 1, 5, 8, 13])
def test_an_interrupted_tuning_gives_the_same_gains(tmp_path: Path, lines: int) -> None:
    """A tuning that goes on from a journal cut within a line gives the same result, to the bit.

    It measures only what the journal lacks.
    """
    options = TuningChoice(axes=["LeftLowerArmY", "LeftHandX", "LeftUpperArmY"], mirror=True)
    body = TunedBody(loaded(ARM).canonical_json, None, 1.7)
    order = TuningOrder(body, {**options.model_dump(mode="json"), "accepted_overshoot_percent": 0})
    expected = result_of(order, tmp_path / "whole")
    journal = (tmp_path / "whole" / "journal.jsonl").read_bytes().splitlines(keepends=True)
    assert len(journal) > 13
    cut = tmp_path / "cut"
    cut.mkdir()
    (cut / "journal.jsonl").write_bytes(b"".join(journal[:lines]) + journal[lines][:40])
    assert len([*TuningFolder(cut).measured()]) == lines
    assert result_of(order, cut) == expected
    again = (cut / "journal.jsonl").read_bytes().splitlines(keepends=True)
    assert again[:lines] == journal[:lines]
    # The broken line stays, and is not read.
    assert sorted(again[lines + 1 :]) == sorted(journal[lines:])


def test_a_tuning_is_stopped_and_resumed(lab: Lab) -> None:
    """A tuning can be stopped once and resumed once, and is then as if it had never stopped."""
    released = threading.Event()
    lab.context.part(TuningQueue)._maker.submit(released.wait)
    started = begun(lab, axes=["LeftLowerArmY"])
    path = f"{PATH}/{started['id']}"
    assert started["progress"]["waiting"]
    assert {one["status"] for one in started["tuned"]} == {"waiting", "kept", "locked"}
    error(lab.operator.post(f"{path}/configuration", json={"accepted": []}), 409, "not_now")
    stopped = ok(lab.operator.post(f"{path}/stop"))
    released.set()
    assert stopped["state"] == "stopped"
    error(lab.operator.post(f"{path}/stop"), 409, "not_now")
    ok(lab.operator.post(f"{path}/resume"))
    assert settled(lab, started["id"])["state"] == "ready"
    error(lab.operator.post(f"{path}/resume"), 409, "not_now")
    ok(lab.operator.delete(path))
    error(lab.operator.get(path), 404, "not_found")


@pytest.mark.one_engine
def test_a_tuning_with_damaged_files_is_shown_as_such(lab: Lab) -> None:
    """Damaged files of one tuning are named in its view, and the others are still listed."""
    released = threading.Event()
    queue = lab.context.part(TuningQueue)
    queue._maker.submit(released.wait)
    tuning_id = begun(lab, axes=["LeftLowerArmY"])["id"]
    path = f"{PATH}/{tuning_id}"
    ok(lab.operator.post(f"{path}/stop"))
    released.set()
    assert ok(lab.operator.get(path))["trouble"] is None
    folder = queue.folder_of(tuning_id)
    good = {"attempt": 1, "phase": "relay", "axis": "LeftLowerArmY", "done": 0, "total": 1}
    wrong: list[Any] = [good | {"phase": "zz"}, good | {"done": "x"}, good | {"axis": None}, [], 5]
    for damaged in wrong:
        (folder / "progress.json").write_text(json.dumps(damaged))
        view = ok(lab.operator.get(path))
        assert "progress.json cannot be read" in view["trouble"]
        assert "resume it" in view["trouble"]
        assert view["trouble"] in [one["trouble"] for one in ok(lab.operator.get(PATH))]
    (folder / "progress.json").write_text(json.dumps(good))
    line = {"run": 0, "attempt": 1, "phase": "relay", "axis": "LeftLowerArmY"}
    whole = line | {"kind": "NoOscillation", "result": {"reason": "stuck"}}
    lines: list[Any] = [5, "x", None, [], whole | {"attempt": "x"}, whole | {"phase": "z"}, line]
    (folder / "journal.jsonl").write_text(
        "".join(f"{json.dumps(one)}\n" for one in [*lines, whole])
    )
    view = ok(lab.operator.get(path))
    elbow = next(one for one in view["tuned"] if one["name"] == "LeftLowerArmY")
    assert (view["trouble"], elbow["reason"]) == (None, "stuck")
    ok(lab.operator.delete(path))


def test_the_end_of_the_server_stops_a_tuning(fresh_lab: Lab, tmp_path: Path) -> None:
    """A tuning that the server's end interrupted is shown as stopped, with what it measured."""
    options = TuningChoice(axes=["LeftLowerArmY"]).model_dump(mode="json")
    content = loaded(ARM)
    row = AvatarTuningRow(
        content_hash=content.content_hash,
        canonical_json=content.canonical_json,
        stature_m=1.75,
        options=options,
        state="tuning",
        by="account:admin",
        at=fresh_lab.context.clock.utc_now(),
    )
    with fresh_lab.database.writing() as db:
        db.add(row)
        db.flush()
        tuning_id = row.id
    queue = fresh_lab.context.part(TuningQueue)
    queue.folder = tmp_path
    order = TuningOrder(TunedBody(content.canonical_json, None, 1.75), options)
    result_of(order, queue.folder_of(tuning_id))
    queue.start()
    view = ok(fresh_lab.operator.get(f"{PATH}/{tuning_id}"))
    assert (view["state"], view["trouble"]) == ("stopped", None)
    elbow = next(one for one in view["tuned"] if one["name"] == "LeftLowerArmY")
    assert elbow["status"] == "tested"
    assert elbow["relay"]["amplitude_deg"] > 1.0
    assert view["progress"]["done"] == view["progress"]["total"] == 1
    ok(fresh_lab.operator.post(f"{PATH}/{tuning_id}/resume"))
    assert settled(fresh_lab, tuning_id)["state"] == "ready"
    assert not queue.folder_of(tuning_id).exists()
