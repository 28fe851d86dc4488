"""Tests of `reembody walk`: fitting, sampling and evaluating from files, and refusals."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from app.cli.commands import app
from app.cli.errors import UNUSABLE
from app.science.walking.synthetic import POPULATIONS, person_of, straight_path, walk_along

OPEN = """
key: hall
bounds_m: [-2, -2, 2, 6]
obstacles:
  - {shape: box, name: table, center_m: [0, 1], size_m: [1.0, 0.4]}
places: {door: [0, 0], desk: [0, 2]}
"""
CLOSED = OPEN.replace("size_m: [1.0, 0.4]", "size_m: [3.99, 0.4]")
QUICK = ("--entries", 300, "--k", 30, "--reading", "time-aware")


def _run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["walk", *(str(argument) for argument in arguments)])


def _figures(*arguments: object) -> dict[str, Any]:
    result = _run(*arguments, "--json")
    assert result.exit_code == 0, result.output
    figures = json.loads(result.stdout)
    assert isinstance(figures, dict)
    return figures


def _refusal(*arguments: object) -> str:
    result = _run(*arguments)
    assert result.exit_code == UNUSABLE, result.output
    assert result.stdout == ""
    return result.stderr


def _write_walks(folder: Path, people: range) -> list[Path]:
    """Write three straight walks for each person, one file per walk."""
    files = []
    for number in people:
        rng = np.random.default_rng((4, number))
        person = person_of(POPULATIONS[0], number, rng)
        for at, length in enumerate((1.0, 2.0, 3.0)):
            track = walk_along(person, straight_path(length), rng)
            rows = [f"{number},{t:.4f},{x:.4f},{y:.4f}" for t, (x, y) in
                    zip(track.times_s[::2], track.xy_m[::2], strict=True)]  # fmt: skip
            path = folder / f"walker-{number}-{at}.csv"
            path.write_text("\n".join(["subject,time_s,x_m,y_m", *rows]) + "\n")
            files.append(path)
    return files


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with walks of four people, statures, scenes, and a model of three of them."""
    folder = tmp_path_factory.mktemp("walks")
    walks = _write_walks(folder, range(4))
    rows = [f"{number},{1.7 + 0.05 * number}" for number in range(4)]
    (folder / "people.csv").write_text("\n".join(["subject,stature_m", *rows]) + "\n")
    (folder / "hall.yaml").write_text(OPEN)
    (folder / "closed.yaml").write_text(CLOSED)
    out, people = folder / "model.npz", folder / "people.csv"
    fit = _figures("fit", *walks[:9], "--out", out, "--people", people, *QUICK)
    assert fit["walks"] == 9
    assert fit["people"] == 3
    assert fit["dependencies"] == ["length_m", "turning_per_m", "stature_m"]
    return folder


def test_the_same_walks_and_seed_fit_the_same_model(lab: Path) -> None:
    """The same walks and seed fit the same model."""
    walks = sorted(lab.glob("walker-[0-2]-*.csv"))
    out, people = lab / "again.npz", lab / "people.csv"
    repeated = _figures("fit", *walks, "--out", out, "--people", people, *QUICK)
    first, second = (
        _figures("sample", path, "--length", 2, "--stature", 1.8, "--seed", 5)
        for path in (lab / "model.npz", out)
    )
    assert len(repeated["content_hash"]) == 64
    assert first == second


def test_samples_are_draws_with_travel_times(lab: Path) -> None:
    """Samples depend only on the seed, lie within bounds, and take longer for longer paths."""
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--count", 80)
    short, long = _figures(*ask, "--length", 1.0), _figures(*ask, "--length", 3.0)
    assert len(short["vectors"]) == 80
    assert np.array(short["vectors"]).min() >= 0.1
    assert np.array(short["vectors"]).max() <= 2.0
    assert 1.0 < np.median(short["durations_s"]) < np.median(long["durations_s"]) < 6.0
    assert short["parameters"] == ["velocity", "acceleration", "angular"]
    assert _figures(*ask, "--length", 1.0) == short
    assert _figures(*ask, "--length", 1.0, "--seed", 2) != short


def test_a_path_in_a_scene_leads_round_its_obstacles(lab: Path) -> None:
    """A path between places or points of a scene leads round its obstacles."""
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--scene", lab / "hall.yaml")
    named = _figures(*ask, "--from", "door", "--to", "desk")
    assert named["length_m"] > 2.1
    assert len(named["points_m"]) > 2
    assert _figures(*ask, "--from", "0,0", "--to", "0,2")["points_m"] == named["points_m"]
    table = _run(*ask, "--from", "door", "--to", "desk")
    assert table.exit_code == 0
    assert "duration, s" in table.stdout


def test_other_people_are_predicted(lab: Path) -> None:
    """A model is evaluated on other people; walks that it was fitted on are refused by default."""
    others, people = sorted(lab.glob("walker-3-*.csv")), lab / "people.csv"
    scores = _figures("evaluate", lab / "model.npz", *others, "--people", people, "--draws", 50)
    assert scores["walks"] == 3
    assert set(scores["models"]) == {"stat", "adapt", "prob"}
    assert all(0.0 < one["crps_s"] < 3.0 for one in scores["models"].values())
    existing = lab / "walker-0-0.csv"
    assert "fitted on 0" in _refusal("evaluate", lab / "model.npz", existing, "--people", people)
    even = _run("evaluate", lab / "model.npz", existing, "--people", people, "--even-fitted")
    assert even.exit_code == 0
    assert "CRPS" in even.stdout


def test_a_fit_names_how_each_walk_was_used(tmp_path: Path) -> None:
    """JSON lists each walk with the distance walked and its path's, and what was left out."""
    along = np.arange(0.0, 3.0, 0.02)
    courses = {
        "A": np.stack([along, np.zeros_like(along)], axis=-1),
        "B": np.stack([np.sin(along), 1.0 - np.cos(along)], axis=-1),
        "C": np.stack([np.sin(2.1 * along), 1.0 - np.cos(2.1 * along)], axis=-1) / 2.1,
    }
    rows = [
        f"{subject},{at},{100.0 * x:.3f},{100.0 * y:.3f}"
        for subject, course in courses.items()
        for at, (x, y) in enumerate(course)
    ]
    table, model = tmp_path / "walks.csv", tmp_path / "model.npz"
    table.write_text("\n".join(["subject,frame,x,y", *rows]) + "\n")
    assert "frame rate" in _refusal("fit", table, "--out", model)
    assert "m, cm, mm are valid" in _refusal("fit", table, "--unit", "inch", "--out", model)
    figures = _figures("fit", table, "--rate-hz", 60, "--unit", "cm", "--out", model, *QUICK)
    straight, curved = figures["fitted"]
    assert (straight["own_path"], curved["own_path"]) == (False, True)
    assert curved["walk"] == "walks.csv, B, walk 1"
    assert curved["walked_m"] == pytest.approx(3.0, rel=0.02)
    assert curved["turning_rad"] == pytest.approx(3.0, rel=0.15)
    (left_out,) = figures["left_out"]
    assert left_out["walk"] == "walks.csv, C, round 1"
    assert "ends within 0.25 m of its start" in left_out["reason"]


def _fit(lab: Path, *arguments: object) -> str:
    out = lab / "refused.npz"
    output = _refusal("fit", *arguments, "--out", out, *QUICK)
    assert not out.exists()
    assert not list(lab.glob(".refused*"))
    return output


def test_invalid_walks_are_refused(lab: Path) -> None:
    """Invalid walks, or walks of only one subject, are refused and nothing is written."""
    bad = lab / "bad.csv"
    bad.write_text("subject,time_s,x_m,y_m\n7,0,0,0\n")
    assert "two" in _fit(lab, bad)
    bad.write_text("subject,time_s,x_m,y_m\n7,0,0,0\n7,0.1,nan,0\n7,0.2,0,1\n")
    assert "line 3" in _fit(lab, bad)
    bad.write_text("subject,time_s,x_m,y_m\n7,0,0,0\n7,0.1,0,0\n7,0.2,0,0.01\n")
    assert "contains no walk" in _fit(lab, bad)
    assert "one subject, '0'" in _fit(lab, *sorted(lab.glob("walker-0-*.csv")))
    assert "gone.csv" in _fit(lab, lab / "gone.csv")


def test_invalid_scenes_and_places_are_refused(lab: Path) -> None:
    """A scene without a path, a goal in an obstacle, and unknown places or scenes are refused."""
    walks = sorted(lab.glob("walker-[0-1]-1.csv"))
    assert "no way" in _fit(lab, *walks, "--scene", lab / "closed.yaml")
    ask = ("sample", lab / "model.npz", "--stature", 1.75, "--scene", lab / "hall.yaml")
    assert "inside obstacle 'table'" in _refusal(*ask, "--from", "door", "--to", "0,1")
    assert "door, desk" in _refusal(*ask, "--from", "door", "--to", "window")
    assert "car-and-three-racks" in _fit(lab, *walks, "--scene", "kitchen")


def test_invalid_requests_for_samples_are_refused(lab: Path) -> None:
    """Sampling without a path or stature, or from a damaged or foreign file, is refused."""
    model = lab / "model.npz"
    assert "one of --length" in _refusal("sample", model)
    assert "stature" in _refusal("sample", model, "--length", 2)
    assert "metres" in _refusal("sample", model, "--length", 2, "--stature", 175)
    assert "not a walking model" in _refusal("sample", lab / "people.csv", "--length", 2)
    content = bytearray(model.read_bytes())
    content[len(content) // 2] ^= 0xFF
    broken = lab / "broken.npz"
    broken.write_bytes(bytes(content))
    assert "model" in _refusal("sample", broken, "--length", 2, "--stature", 1.75)


def test_a_model_is_replaced_whole_or_not_at_all(lab: Path) -> None:
    """A fit that fails leaves the existing model file unchanged."""
    out = lab / "kept.npz"
    out.write_bytes((lab / "model.npz").read_bytes())
    before = out.read_bytes()
    _refusal("fit", lab / "walker-0-0.csv", "--out", out, *QUICK)
    assert out.read_bytes() == before
