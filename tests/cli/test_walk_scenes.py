"""Tests of `reembody walk` with recordings of several scenes, each walk planned in its own."""

from pathlib import Path

import pytest

from tests.cli.walk_command import QUICK, figures, refusal, run, write_walks

HALL = """
key: hall
bounds_m: [-2, -2, 2, 6]
obstacles:
  - {shape: box, name: table, center_m: [0, 1], size_m: [1.0, 0.4]}
"""


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with straight walks of two people, and two scenes with a table in the way."""
    write_walks(tmp_path, range(2))
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "hall.yaml").write_text(HALL)
    (tmp_path / "empty.yaml").write_text("key: empty\nbounds_m: [-2, -2, 2, 6]\n")
    return tmp_path


def people(lab: Path, *rows: str, header: str = "subject,stature_m,file,scene") -> Path:
    """Write the list of people and return its path."""
    path = lab / "people.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def one_table(lab: Path, scene_of: dict[float, str]) -> Path:
    """Write the walks of 3 m as one table, with the scene by the share of the walk done."""
    lines = ["subject,time_s,x_m,y_m,scene"]
    for file in sorted(lab.glob("walker-?-2.csv")):
        for row in file.read_text().splitlines()[1:]:
            done = float(row.split(",")[3]) / 3.0
            lines.append(f"{row},{next(name for end, name in scene_of.items() if done <= end)}")
    path = lab / "table.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


def test_each_recording_is_planned_in_the_scene_that_is_named_for_it(lab: Path) -> None:
    """The list of people names a scene for each file; others have --scene, or the open floor."""
    files = sorted(lab.glob("walker-*.csv"))
    named = people(lab, "0,1.7,walker-0-2.csv,scenes/hall.yaml", "1,1.8,walker-1-2.csv,open floor")
    asked = ("fit", *files, "--people", named, "--out", lab / "model.npz", *QUICK)
    found = figures(*asked)
    scenes = {one["walk"]: one["scene"] for one in found["fitted"]}
    assert set(scenes.values()) == {None}
    # Who walks straight through a table did not walk in that scene.
    (left_out,) = found["left_out"]
    assert left_out["walk"] == "walker-0-2.csv, 0, walk 1"
    assert "crosses an obstacle" in left_out["reason"]
    rest = figures(*asked, "--scene", lab / "empty.yaml")
    scenes = {one["walk"]: one["scene"] for one in rest["fitted"]}
    assert scenes["walker-1-2.csv, 1, walk 1"] is None
    assert scenes["walker-1-0.csv, 1, walk 1"] == "empty"
    told = run(*asked, "--scene", lab / "empty.yaml").stdout
    assert "scenes        4 walks in empty, 1 walk on the open floor" in told


def test_the_nearest_statement_about_a_scene_counts(lab: Path) -> None:
    """A row of the table counts before its file's, that before its person's, that before all."""
    table = one_table(lab, {9.0: ""})
    rows = ["0,1.7,,scenes/hall.yaml", "1,1.8,,open floor", ",,table.csv,empty.yaml"]
    asked = ("fit", table, *sorted(lab.glob("walker-?-1.csv")), "--out", lab / "model.npz", *QUICK)
    found = figures(*asked, "--people", people(lab, *rows))
    scenes = {one["walk"]: one["scene"] for one in found["fitted"]}
    assert scenes == {
        "table.csv, 0, walk 1": "empty",
        "table.csv, 1, walk 1": "empty",
        "walker-1-1.csv, 1, walk 1": None,
    }
    one_table(lab, {9.0: "open floor"})
    found = figures(*asked, "--people", people(lab, *rows))
    assert [one["scene"] for one in found["fitted"]] == [None, None, None]


def test_a_change_of_scene_cuts_the_track(lab: Path) -> None:
    """Where the scene changes amid walking, one walk ends and the next begins, both at speed."""
    table = one_table(lab, {0.5: "empty.yaml", 9.0: "open floor"})
    found = figures("fit", table, "--out", lab / "model.npz", *QUICK)
    assert [one["scene"] for one in found["fitted"]] == ["empty", None, "empty", None]
    assert found["cut_walks"] == 4


def test_a_scene_that_does_not_exist_is_refused_at_its_line(lab: Path) -> None:
    """An unknown scene is refused with the file, the line, the value, and those that exist."""
    files, out = sorted(lab.glob("walker-*.csv")), ("--out", lab / "model.npz", *QUICK)
    named = people(lab, "0,1.7,walker-0-0.csv,", "1,1.8,walker-1-0.csv,pole")
    told = refusal("fit", *files, "--people", named, *out)
    assert "people.csv, line 3: there is no scene 'pole'" in told
    assert "car-and-three-racks, car-between-two-racks, and 'open floor'" in told
    assert "give the path of its file" in told
    table = one_table(lab, {0.5: "empty.yaml", 9.0: "pole"})
    told = refusal("fit", table, *out)
    line = next(at for at, row in enumerate(table.read_text().splitlines(), 1) if "pole" in row)
    assert f"table.csv, line {line}: there is no scene 'pole'" in told
    twice = people(lab, "0,1.7,,open floor", "0,1.7,,empty.yaml")
    told = refusal("fit", *files, "--people", twice, *out)
    assert "line 3: scene is 'empty', but an earlier row about the same says 'open floor'" in told
    (lab / "other.yaml").write_text("key: empty\nbounds_m: [-3, -2, 2, 6]\n")
    same = people(lab, "0,1.7,,other.yaml", "1,1.8,,empty.yaml")
    assert "another scene has the key 'empty'" in refusal("fit", *files, "--people", same, *out)


def test_walks_are_evaluated_in_their_scenes(lab: Path) -> None:
    """An evaluation reads the scene of each recording as a fit does."""
    files, model = sorted(lab.glob("walker-*.csv")), lab / "model.npz"
    figures("fit", *files, "--out", model, *QUICK)
    named = people(lab, "0,,walker-0-2.csv,scenes/hall.yaml", "1,,walker-1-0.csv,empty.yaml")
    asked = ("evaluate", model, *files, "--people", named, "--even-fitted", "--draws", 20)
    found = figures(*asked)
    assert found["walks"] == 5
    assert [one["walk"] for one in found["left_out"]] == ["walker-0-2.csv, 0, walk 1"]


def test_every_problem_of_a_scene_file_is_told_with_its_line_and_remedy(lab: Path) -> None:
    """A scene that cannot be read is refused with a line for each problem, and what to do."""
    bad = lab / "bad.yaml"
    bad.write_text("key: Bad\nbounds_m: [-2, -2, 2]\nobstacles:\n  - {shape: round, name: pole}\n")
    told = refusal("sample", lab / "none.npz", "--scene", bad, "--from", "a", "--to", "b")
    problems = told.splitlines()[1:]
    assert [one.partition(":")[0].strip() for one in problems] == ["line 1", "line 2", "line 4"]
    assert problems[1].endswith("The list ends after 3 values. Add the missing values.")
