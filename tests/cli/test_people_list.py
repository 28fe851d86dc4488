"""Tests of lists of people for `reembody walk` and `reembody reach`: which row is about which file.

Both commands match rows with recordings in the same way, and refuse what contradicts itself.
"""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.people_list import labels_of, matching
from app.science.reaching import Reacher
from tests.cli.invoked import Invoked
from tests.cli.walk_command import QUICK, figures, refusal, write_walks
from tests.science.reaching.reachers import Planted, as_tracker_file, hand_of

REACH = Invoked("reach")


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with walks and reaches of two people, in files of the same names."""
    files = write_walks(tmp_path, range(2))
    for at in range(2):
        folder = tmp_path / f"P{at}"
        folder.mkdir()
        for number, path in enumerate(files[3 * at : 3 * at + 3]):
            rows = [line.partition(",")[2] for line in path.read_text().splitlines()]
            (folder / f"{number}.csv").write_text("\n".join(rows) + "\n")
            path.unlink()
        track = hand_of(Planted(1.0 + at), Reacher("", ""), np.random.default_rng(at), count=12)
        (folder / "right.csv").write_text(as_tracker_file(track))
    (tmp_path / "hall.yaml").write_text("key: hall\nbounds_m: [-2, -2, 2, 6]\n")
    return tmp_path


def _people(lab: Path, *lines: str, encoding: str = "utf-8") -> Path:
    path = lab / "people.csv"
    path.write_text("\n".join(lines) + "\n", encoding=encoding)
    return path


def _walk(lab: Path) -> tuple[object, ...]:
    return ("fit", *sorted(lab.glob("P?/[0-9].csv")), "--out", lab / "model.npz", *QUICK)


def _reach(lab: Path) -> tuple[object, ...]:
    return ("fit", *sorted(lab.glob("**/right.csv")), "--out", lab / "reaching.npz")


def _scenes(found: dict[str, Any]) -> dict[str, str | None]:
    return {one["walk"]: one["scene"] for one in found["fitted"]}


def test_names_match_by_the_ends_of_paths_and_the_longest_comes_first() -> None:
    """A name matches whole parts of a path only, and the most particular one is the first."""
    names = ["right.csv", "ight.csv", "P8/right.csv", "P7/right.csv", "a/P7/right.csv"]
    found = matching(Path("b/P7/right.csv"), names)
    assert found == ["P7/right.csv", "right.csv"]
    assert matching(Path("b/P8/../P7/right.csv"), names) == found


def test_files_of_one_name_get_labels_that_tell_them_apart() -> None:
    """A label is the file's name, with as many folders as it takes."""
    files = [Path("/a/P7/right.csv"), Path("/a/P8/right.csv"), Path("/a/left.csv")]
    assert list(labels_of(files).values()) == ["P7/right.csv", "P8/right.csv", "left.csv"]


def test_walks_in_files_of_one_name_are_told_apart_by_their_folders(lab: Path) -> None:
    """Rows name folder and file; walks and people are named likewise where nothing else is."""
    rows = [f"P{at}/{one}.csv,A{at},{1.7 + at / 10},{'hall.yaml' if one else ''}"
            for at in range(2) for one in range(3)]  # fmt: skip
    named = _people(lab, "file,subject,stature_m,scene", *rows)
    found = figures(*_walk(lab), "--people", named)
    assert (found["people"], found["notices"]) == (2, [])
    assert _scenes(found) == {
        f"P{at}/{one}.csv, A{at}, walk 1": "hall" if one else None
        for at in range(2)
        for one in range(3)
    }
    bare = figures(*_walk(lab))
    assert bare["people_named_by_file"] == [f"P{at}/{one}" for at in range(2) for one in range(3)]


def test_a_row_of_a_misspelt_file_is_refused(lab: Path) -> None:
    """A row without its recording and a recording without a row are one mistake, with its line."""
    rows = [f"P{at}/{one}.csv,A{at}" for at in range(2) for one in range(3)]
    named = _people(lab, "file,subject", *rows[:-1], "P1/two.csv,A1")
    told = refusal(*_walk(lab), "--people", named)
    assert "people.csv, line 7: file is 'P1/two.csv', but no recording has this name" in told
    assert "nothing is said of P1/2.csv" in told
    named = _people(lab, "file,subject", "P0/right.csv,A", "P1/rigth.csv,B")
    told = REACH.refusal(*_reach(lab), "--people", named)
    assert "people.csv, line 3: file is 'P1/rigth.csv', but no recording has this name" in told


def test_a_row_about_a_recording_that_is_not_used_is_noted(lab: Path) -> None:
    """One list may be about more recordings than are given, and each idle row is named."""
    rows = ("P0/right.csv,A", "P1/right.csv,B", "P2/right.csv,C")
    found = REACH.figures(*_reach(lab), "--people", _people(lab, "file,subject", *rows))
    assert list(found["levels"]) == ["A", "B"]
    (notice,) = found["notices"]
    assert "line 4: file is 'P2/right.csv', and no recording has this name" in notice


def test_a_row_about_several_recordings_is_refused(lab: Path) -> None:
    """A name with which two recordings end would make one person of two."""
    named = _people(lab, "file,subject", "right.csv,A")
    told = REACH.refusal(*_reach(lab), "--people", named)
    assert "people.csv, line 2: file is 'right.csv', which is the end of" in told
    assert "as much of its path as tells it apart" in told


def test_the_longest_name_of_a_recording_counts(lab: Path) -> None:
    """A row of the bare name, wherever it stands, is about the file that no longer one names."""
    shutil.copy(lab / "P0" / "2.csv", lab / "right.csv")
    track = hand_of(Planted(1.2), Reacher("", ""), np.random.default_rng(9), count=12)
    (lab / "right.csv").write_text(as_tracker_file(track))
    rows = ("right.csv,C", "P0/right.csv,A", "P1/right.csv,B")
    found = REACH.figures(*_reach(lab), "--people", _people(lab, "file,subject", *rows))
    assert sorted(found["levels"]) == ["A", "B", "C"]


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("file,subject,stature_m", "P0/0.csv,A,1.7", "P0/1.csv,A,1.8"), "line 3: stature_m of"),
        (("file,subject", "P0/0.csv,A", "P0/0.csv,B"), "line 3: the file 'P0/0.csv' is of 'B'"),
        (("file,Subject", "P0/0.csv,A"), "column subject; its first line names 'file', 'Sub"),
        (("file;subject", "P0/0.csv;A"), "names 'file;subject'. It needs subject and"),
        (("file,subject,subject", "P0/0.csv,A,B"), "the column subject is there twice"),
        (("file,subject,stature_m", "P0/0.csv,A,1,7"), "line 2: 4 cells, but the list has 3"),
        (("file,subject,stature_m", "P0/0.csv,A,1_7"), "line 2: stature_m is '1_7', not a number"),
    ],
)
def test_contradictions_in_a_list_for_walks_are_refused(
    lines: tuple[str, ...], said: str, lab: Path
) -> None:
    """What a list says twice and differently, or not as it is read, is refused with its place."""
    told = refusal(*_walk(lab), "--people", _people(lab, *lines))
    assert "people.csv" in told
    assert said in told


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("right.csv,A,", "right.csv,B,"), "line 3: subject of 'right.csv' is 'B'"),
        (("right.csv,A,.1", "./right.csv,A,.2"), "line 3: width_m of 'right.csv' is 0.2"),
    ],
)
def test_contradictions_in_a_list_for_reaches_are_refused(
    lines: tuple[str, ...], said: str, lab: Path
) -> None:
    """A recording of two people, or with targets of two widths, is refused with its line."""
    named = _people(lab, "file,subject,width_m", *lines)
    told = REACH.refusal("fit", lab / "P0" / "right.csv", "--out", lab / "r.npz", "--people", named)
    assert said in told
    assert "an earlier row about the same says" in told


def test_a_list_may_be_utf_16_and_name_a_scene_before_its_file(lab: Path) -> None:
    """A list of any encoding is read, and a row may use the key of a scene that a later one has."""
    rows = [f"P{at}/{one}.csv,A{at},{'hall' if at == 0 else 'hall.yaml'}"
            for at in range(2) for one in range(3)]  # fmt: skip
    named = _people(lab, "file,subject,scene", *rows, encoding="utf-16")
    assert set(_scenes(figures(*_walk(lab), "--people", named)).values()) == {"hall"}


def test_a_scene_file_may_not_have_the_key_of_a_shipped_scene(lab: Path) -> None:
    """A scene with the key of another one of the product is refused: rows would mean either."""
    (lab / "hall.yaml").write_text("key: car-and-three-racks\nbounds_m: [-2, -2, 2, 6]\n")
    told = refusal(*_walk(lab), "--scene", lab / "hall.yaml")
    assert "hall.yaml has the key 'car-and-three-racks', which is that of a scene of the" in told
