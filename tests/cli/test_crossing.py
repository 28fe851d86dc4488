"""Tests of `reembody crossing`: scenes that are included, records, refusals, extras, an FMU."""

import hashlib
import json
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from app.adapters.cosimulation import shipped_scenes, sumo_partner
from app.cli.commands import app
from app.cli.errors import INCOMPLETE, UNUSABLE

DOCS = Path(__file__).parents[2] / "docs" / "crossing.md"
SCENE = """
key: test
duration_s: 3
partners:
  - {name: p, kind: path, points: [[0, 0, -5], [3, 0, -1]]}
  - name: cars
    kind: cars
    flows: [{lane: near, headway_s: 3, count: 2, speed_m_s: 12}]
"""


def _run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["crossing", *(str(argument) for argument in arguments)])


def _figures(*arguments: object) -> dict[str, Any]:
    result = _run("run", *arguments, "--json")
    assert result.exit_code == 0, result.output
    figures = json.loads(result.stdout)
    assert isinstance(figures, dict)
    return figures


def test_the_included_street_gives_a_record_that_the_seed_repeats(tmp_path: Path) -> None:
    """Equal seeds give equal files, other seeds others; the printed hash is the file's."""
    files = [tmp_path / name for name in ("1a.jsonl", "1b.jsonl", "2.jsonl")]
    first, again, other = (
        _figures("quiet-street", "--seed", seed, "--out", file)
        for seed, file in zip((1, 1, 2), files, strict=True)
    )
    assert files[0].read_bytes() == files[1].read_bytes() != files[2].read_bytes()
    assert first["record_sha256"] == hashlib.sha256(files[0].read_bytes()).hexdigest()
    assert again["record_sha256"] == first["record_sha256"] != other["record_sha256"]
    assert (first["ended"], first["steps"], first["guesses"]["count"]) == ("complete", 2000, 0)
    (crossed,) = first["crossings"]
    assert crossed["collision"] is None
    assert crossed["steps_off_s"] > crossed["steps_on_s"]
    lines = files[0].read_text().splitlines()
    assert len(lines) == 1 + 2001 + 1
    assert json.loads(lines[0])["scene"] == "quiet-street"
    assert json.loads(lines[-1]) == {"ended": "complete", "reason": ""}


def test_a_vehicle_in_its_own_process_gives_equal_bytes() -> None:
    """The included example starts `crossing vehicle`, which drives up to the crossing."""
    first = _figures("crossing-with-a-vehicle")
    assert first["ended"] == "complete"
    assert first["crossings"][0]["steps_off_s"] is not None
    assert _figures("crossing-with-a-vehicle")["record_sha256"] == first["record_sha256"]


def test_what_is_wrong_with_a_scene_is_said_with_its_line(tmp_path: Path) -> None:
    """Unknown files, misspelt keys, impossible numbers and paths are refused, with the remedy."""
    missing = _run("run", "nowhere.yaml")
    assert missing.exit_code == UNUSABLE
    assert "included scenes are crossing-by-sumo" in missing.stderr
    for wrong, said in (
        (SCENE.replace("headway_s", "headway"), "line 8"),
        (SCENE.replace("kind: path", "kind: bird"), "line 5"),
        (SCENE.replace("duration_s: 3", "step_s: 0.02\nduration_s: -3"), "line 4"),
        (SCENE.replace("points: [[0, 0, -5], [3, 0, -1]]", ""), "needs either points or a file"),
        (SCENE.replace("[3, 0, -1]", "[0, 0, -1]"), "must increase"),
        (SCENE.replace("kind: cars", "kind: cars\n    step_s: 0.03"), "must be a multiple"),
    ):
        file = tmp_path / "scene.yaml"
        file.write_text(wrong)
        refused = _run("run", file)
        assert refused.exit_code == UNUSABLE, wrong
        assert said in refused.stderr
        assert refused.stdout == ""
    assert _run("vehicle", "--connect", "nowhere").exit_code == UNUSABLE
    assert "traffic, fmu" in _run("install", "city").stderr
    file.write_text(SCENE)
    said = _run("run", file).stdout
    assert "p: on the carriageway at 1.36 s, not across" in said
    assert "nothing was extrapolated" in said


def test_a_lost_partner_ends_the_run_with_its_record(tmp_path: Path) -> None:
    """Exit code 1 and the reason; what was recorded is written."""
    file, out = tmp_path / "scene.yaml", tmp_path / "record.jsonl"
    file.write_text(
        SCENE
        + "  - {name: gone, kind: process, connect_s: 5, command: ['{python}', -c, 'exit(3)']}"
    )
    result = _run("run", file, "--out", out)
    assert result.exit_code == INCOMPLETE
    assert "'gone' ended with exit code 3 before it connected." in result.stderr
    assert json.loads(out.read_text().splitlines()[-1])["ended"] == "partner lost"


def test_without_the_extra_everything_else_works(monkeypatch: pytest.MonkeyPatch) -> None:
    """Scenes by SUMO name the command that adds it; all scenes are still listed."""
    monkeypatch.setattr(sumo_partner, "find_spec", lambda _: None)
    refused = _run("run", "crossing-by-sumo")
    assert refused.exit_code == UNUSABLE
    assert "`reembody crossing install traffic`" in refused.stderr
    listed = json.loads(_run("scenes", "--json").stdout)
    assert [one["key"] for one in listed] == list(shipped_scenes())
    assert [one["key"] for one in listed if one["missing"]] == ["crossing-by-sumo"]


@pytest.mark.skipif(
    find_spec("fmpy") is None or find_spec("pythonfmu") is None,
    reason="FMUs are an extra: reembody crossing install fmu",
)
def test_the_documented_fmu_drives_and_stops(tmp_path: Path) -> None:
    """The page's car becomes an FMU in a process of its own, and stops for a standing person."""
    source = re.search(r"```python\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    assert source is not None
    (tmp_path / "car.py").write_text(source[1])
    build = [sys.executable, "-m", "pythonfmu", "build", "-f", "car.py"]
    subprocess.run(build, cwd=tmp_path, check=True, capture_output=True)
    vehicle = re.search(r"```yaml\n(  - name: vehicle.*?)```", DOCS.read_text(), re.DOTALL)
    assert vehicle is not None
    file = tmp_path / "scene.yaml"
    person = "  - {name: p, kind: path, points: [[0, 0, -4], [4, 0, -4], [6, 0, -1.6]]}\n"
    file.write_text(f"key: fmu\nduration_s: 20\npartners:\n{person}{vehicle[1]}")
    figures = _figures(file, "--out", tmp_path / "record.jsonl")
    assert figures["crossings"][0]["collision"] is None
    last = json.loads((tmp_path / "record.jsonl").read_text().splitlines()[-2])
    (car,) = (one for one in last["actors"] if one["kind"] == "car")
    assert car["speed_m_s"] < 0.05
    assert -6.0 < car["x_m"] + 2.25 < -0.25
