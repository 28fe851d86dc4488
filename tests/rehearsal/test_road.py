"""Tests of a rehearsed session in which the participant crosses a road, from file to export."""

import asyncio
import csv
import hashlib
import io
import json
import time
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from app.database import open_database
from app.features.results.analysis.dashboard import build_dashboard
from app.features.results.analysis.schemas import NO_FILTER
from app.rehearsal.rehearse import RehearsalPlan, RehearsalReport, rehearse, store_template
from app.resources import study_configs_dir
from tests.features.lab import ok
from tests.support.server import ADMIN_PASSWORD, LiveServer

TEMPLATE = study_configs_dir() / "templates" / "road-crossing.yaml"
SHORTER = (
    ("key: road-crossing", "key: road-short"),
    ("duration_s: 60, latency_ms: 0", "duration_s: 2, latency_ms: 0"),
    ("crossings: 2", "crossings: 1"),
    ("preparation_s: 5", "preparation_s: 1"),
    ("freeze_s: 3", "freeze_s: 0.5"),
)
STEP_S = 0.02


def short_study() -> str:
    """Return the template with one crossing a block, and short waits."""
    text = TEMPLATE.read_text(encoding="utf-8")
    for old, new in SHORTER:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def _rehearsed(server: LiveServer) -> RehearsalReport:
    plan = RehearsalPlan(
        url=server.url, study="road-short", speed=20.0, seed=1, password=ADMIN_PASSWORD
    )
    return asyncio.run(rehearse(plan))


def _lines(record: bytes) -> list[dict[str, Any]]:
    return [json.loads(line) for line in record.decode().splitlines()]


@pytest.mark.timeout(600)
def test_a_visit_crosses_the_road_and_all_of_it_is_stored_and_exported(tmp_path: Path) -> None:
    """Both crossings have their measures, their record hashes to what is stored, and are exported.

    The traffic of a block is that of its seed, and the participant is where the record of their
    body says.
    """
    with LiveServer(tmp_path) as server, server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        ok(api.post("/api/studies", json={"yaml": short_study()}))
        report = _rehearsed(server)
        assert report.status == "completed"
        crossed = [phase for phase in report.phases if phase["kind"] == "road_crossing"]
        assert [phase["completions"] for phase in crossed] == [1, 1]
        assert [one["is_across"] for one in report.crossings] == [True, True]
        road = ok(api.get(f"/api/sessions/{report.session_id}/road"))
        assert [run["ended"] for run in road["runs"]] == ["complete", "complete"]
        assert len({run["seed"] for run in road["runs"]}) == 2
        for run in road["runs"]:
            record = api.get(f"/api/sessions/{report.session_id}/road/{run['id']}").content
            assert hashlib.sha256(record).hexdigest() == run["sha256"]
            lines = _lines(record)
            assert lines[-1]["ended"] == "complete"
            assert len(lines) == run["steps"] + 3
            (crossing,) = run["crossings"]
            assert crossing["waited_s"] >= 1.0
            assert crossing["steps_off_s"] - crossing["steps_on_s"] > 2.0
            last = {one["name"]: one for one in lines[-2]["actors"]}
            assert abs(last["participant"]["y_m"]) > 2.5
            assert sum(one["kind"] == "car" for one in last.values()) >= 2
        _check_export(api, report)
    _check_results(server)


def _check_results(server: LiveServer) -> None:
    """Figures and tests that are about boxes leave a phase on the road out, and none fails."""
    database = open_database(f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
    try:
        with database.reading() as db:
            drawn = build_dashboard(db, "road-short", "simulated", NO_FILTER)
    finally:
        database.close()
    crossings = {one.key: one for one in drawn.figures if one.key.startswith("crossing_")}
    assert len(crossings) == 5
    waited = crossings["crossing_waited_s"]
    assert (waited.n, waited.empty) == (1, None)


def _check_export(api: Any, report: RehearsalReport) -> None:
    body = {"kind": "simulated", "movement": True}
    job = ok(api.post("/api/studies/road-short/exports", json=body))
    while job["state"] not in ("ready", "done", "failed"):
        time.sleep(0.2)
        job = ok(api.get(f"/api/exports/{job['id']}"))
    assert job["state"] != "failed", job
    archive = zipfile.ZipFile(io.BytesIO(api.get(f"/api/exports/{job['id']}/file").content))
    names = {Path(name).name: name for name in archive.namelist()}
    table = archive.read(names["road_crossings.csv"]).decode()
    rows = list(csv.DictReader(io.StringIO(table)))
    assert [row["is_across"] for row in rows] == ["true", "true"]
    assert [row["simulated"] for row in rows] == ["true", "true"]
    assert [float(row["steps_on_s"]) for row in rows] == [
        one["steps_on_s"] for one in report.crossings
    ]
    records = {
        hashlib.sha256(archive.read(name)).hexdigest()
        for name in archive.namelist()
        if "/road/" in f"/{name}"
    }
    assert records == {row["record_sha256"] for row in rows}


def test_a_template_can_be_rehearsed_by_its_key(tmp_path: Path) -> None:
    """On a server of its own the rehearsal stores the template first, once."""
    plan = RehearsalPlan(url="", study="road-crossing", speed=1.0, seed=1)
    with LiveServer(tmp_path) as server, server.client() as api:
        here = replace(plan, url=server.url, password=ADMIN_PASSWORD)
        for _ in range(2):
            asyncio.run(store_template(here))
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        study = ok(api.get("/api/studies/road-crossing"))
        assert study["newest"]["number"] == 1 if "newest" in study else study["phases"] == 3
