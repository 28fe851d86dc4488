"""Tests of `reembody reach`: fitting, evaluating and sampling from files, and refusals."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.science.reaching import Reacher
from tests.cli.exported_samples import as_samples, poses_of_reaches
from tests.cli.invoked import Invoked
from tests.science.reaching.reachers import Planted, as_tracker_file, hand_of

_COMMAND = Invoked("reach")
TEMPOS = (1.0, 1.3, 1.6)


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the recordings of three people, who they are, and their model."""
    folder = tmp_path_factory.mktemp("reaches")
    for at, tempo in enumerate(TEMPOS):
        rng = np.random.default_rng((3, at))
        track = hand_of(Planted(tempo), Reacher("", ""), rng, count=12)
        (folder / f"{at}.csv").write_text(as_tracker_file(track))
    rows = [f"{at}.csv,P{at},0.1" for at in range(3)]
    (folder / "people.csv").write_text("\n".join(["file,subject,width_m", *rows]) + "\n")
    _fit(folder, "reaching.npz")
    return folder


def _recordings(folder: Path) -> list[Path]:
    return sorted(folder.glob("[0-9].csv"))


def _fit(folder: Path, out: str, *more: object) -> dict[str, Any]:
    people = ("--people", folder / "people.csv", "--synthetic")
    return _COMMAND.figures("fit", *_recordings(folder), "--out", folder / out, *(more or people))


def test_planted_people_are_found_in_files(lab: Path) -> None:
    """Names, targets' widths and tempos are those of the files, and so is what made them."""
    found = _fit(lab, "again.npz")
    assert (found["people"], found["reaches"], found["synthetic"]) == (3, 36, 36)
    assert found["dependencies"] == ["distance_m", "difficulty_bits"]
    assert list(found["levels"]) == ["P0", "P1", "P2"]
    assert list(found["levels"].values()) == pytest.approx(list(TEMPOS), rel=0.08)
    assert found["tempo_interval"][0] < np.exp(np.mean(np.log(TEMPOS))) < found["tempo_interval"][1]
    assert (found["people_named_by_file"], found["notices"]) == ([], [])


def test_the_same_recordings_and_seed_give_the_same_file(lab: Path) -> None:
    """Fitted again, the file has the same hash; with another seed it has not."""
    hashes = [_fit(lab, "again.npz")["sha256"] for _ in range(2)]
    people = ("--people", lab / "people.csv", "--synthetic", "--seed", 2)
    assert hashes[0] == hashes[1] != _fit(lab, "other.npz", *people)["sha256"]


def test_without_a_table_people_are_their_files(lab: Path) -> None:
    """People known by their files are listed, and widths are unknown."""
    found = _fit(lab, "bare.npz", "--seed", 1)
    assert found["people_named_by_file"] == ["0", "1", "2"]
    assert (found["dependencies"], found["synthetic"]) == (["distance_m"], 0)


def test_a_recording_given_twice_is_left_out_by_name(lab: Path) -> None:
    """A copy under another name adds nothing, and the notice says which it was."""
    copy = lab / "copies" / "other.csv"
    copy.parent.mkdir()
    shutil.copy(lab / "0.csv", copy)
    found = _COMMAND.figures("fit", *_recordings(lab), copy, "--out", lab / "twice.npz")
    assert found["reaches"] == 36
    assert found["notices"] == ["other.csv, right: given before, sample for sample; left out"]


def test_people_of_uxf_are_those_of_its_folders(lab: Path) -> None:
    """Files of the same name in two participants' folders are two people's."""
    for at, who in enumerate(("07", "08")):
        tracker = lab / "study" / who / "S001" / "trackers" / "hand_T001.csv"
        tracker.parent.mkdir(parents=True)
        shutil.copy(lab / f"{at}.csv", tracker)
    files = sorted((lab / "study").rglob("*.csv"))
    found = _COMMAND.figures("fit", *files, "--out", lab / "uxf.npz")
    assert list(found["levels"]) == ["07", "08"]


def test_the_evaluation_compares_maps_constants_and_a_line(lab: Path) -> None:
    """Each of three people is left out; so few get no interval, and a verdict that says so."""
    found = _COMMAND.figures("evaluate", lab / "reaching.npz", "--draws", 100)
    assert [one["method"] for one in found["scores"]] == ["maps", "assumed", "line"]
    assert (found["left_out"], found["groups"]) == ("people", 3)
    assert all(0.0 < one["crps_s"] < 0.5 for one in found["scores"])
    assert all(one["interval_s"] is None for one in found["scores"])
    assert "too few to say" in found["verdict"]
    assert "SYNTHETIC" in _COMMAND.run("evaluate", lab / "reaching.npz", "--draws", 20).stdout


def test_samples_take_longer_farther_and_to_smaller_targets(lab: Path) -> None:
    """Times rise with distance and with a smaller width; the same seed gives the same draws."""
    ask = ("sample", lab / "reaching.npz", "--count", 400)
    near, far = (_COMMAND.figures(*ask, "--distance", metres) for metres in (0.2, 0.6))
    assert np.median(near["durations_s"]) < np.median(far["durations_s"])
    assert _COMMAND.figures(*ask, "--distance", 0.2) == near
    small = _COMMAND.figures(*ask, "--distance", 0.2, "--width", 0.02)
    assert np.median(near["durations_s"]) < np.median(small["durations_s"])
    assert near["synthetic"] is True


def test_a_distance_that_was_not_recorded_is_called_a_guess(lab: Path) -> None:
    """The notes name the distance and the recorded ones."""
    (note,) = _COMMAND.figures("sample", lab / "reaching.npz", "--distance", 1.9)["notes"]
    assert "1.9 m is outside of the recorded distances" in note


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("fit", "0.csv", "--out", "x.npz", "--hand", "foot"), "nothing named 'foot' among right"),
        (("fit", "0.csv", "--out", "x.npz", "--people", "strange.csv"), "none of which is among"),
        (("fit", "0.csv", "--out", "x.npz", "--people", "0.csv"), "has no column file and subject"),
        (("fit", "0.csv", "--out", "x.npz", "--people", "wide.csv"), "'broad', not a number"),
        (("fit", "people.csv", "--out", "x.npz"), "people.csv"),
        (("sample", "reaching.npz", "--distance", "40"), "0.01 to 3 m are valid; give metres"),
        (("sample", "reaching.npz", "--distance", ".4", "--width", "9"), "0.001 to 2 m are valid"),
        (("evaluate", "0.csv"), "not a file of how people reach"),
    ],
)
def test_unusable_input_is_refused(
    lab: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], said: str
) -> None:
    """Each refusal says what is wrong and what is valid, and nothing is written."""
    (lab / "strange.csv").write_text("file,subject\nnobody.csv,P9\n")
    (lab / "wide.csv").write_text("file,subject,width_m\n0.csv,P0,broad\n")
    monkeypatch.chdir(lab)
    assert said in _COMMAND.refusal(*arguments)
    assert not (lab / "x.npz").exists()


def test_the_simulations_own_reaches_have_the_tempo_that_it_was_given(tmp_path: Path) -> None:
    """Whole bodies that the simulation moved, exported and read again, have their planted tempos.

    They lean, are noisy and correct what they see, which the agent does not.
    """
    rows = ["file,subject,width_m,stature_m"]
    for at, tempo in enumerate((1.0, 1.5)):
        (tmp_path / f"{at}.csv").write_text(as_samples(poses_of_reaches(at, 12, tempo)))
        rows.append(f"{at}.csv,P{at},0.1,1.75")
    (tmp_path / "people.csv").write_text("\n".join(rows) + "\n")
    found = _fit(tmp_path, "reaching.npz", "--people", tmp_path / "people.csv")
    assert found["synthetic"] == found["reaches"] >= 16
    assert list(found["levels"].values()) == pytest.approx([1.0, 1.5], rel=0.15)
    assert all("use phases in which hands reach freely" in one for one in found["notices"])
    assert len(found["notices"]) == 2


def test_samples_of_an_export_need_a_stature(tmp_path: Path) -> None:
    """Rotations do not say where a hand is, and the message says what to give."""
    (tmp_path / "session.csv").write_text(as_samples(poses_of_reaches(1, 1)))
    said = _COMMAND.refusal("fit", tmp_path / "session.csv", "--out", tmp_path / "x.npz")
    assert "give the person's stature_m in the table of --people" in said


def test_one_code_in_several_folders_is_said_to_be_taken_as_one_person(lab: Path) -> None:
    """A person's folder of the same code in two studies is one person, as the notices say."""
    studies = [lab / name / "7" / "S001" / "trackers" / "hand.csv" for name in ("first", "second")]
    for at, file in enumerate(studies):
        file.parent.mkdir(parents=True)
        shutil.copy(lab / f"{at}.csv", file)
    asked = ("fit", *studies, lab / "2.csv", "--out", lab / "codes.npz")
    found = _COMMAND.figures(*asked)
    (said,) = (one for one in found["notices"] if "is taken as one" in one)
    assert said.startswith("person '7' is in 2 folders (first/7, second/7)")
    told = _COMMAND.run(*asked).stdout
    assert "2 people known only by a file or a folder, with the code: '2', '7'" in told


def test_files_of_one_name_in_two_folders_are_two_people(lab: Path) -> None:
    """What tells the files apart tells the people apart, unless the list says otherwise."""
    twin = lab / "again" / "0.csv"
    twin.parent.mkdir()
    shutil.copy(lab / "1.csv", twin)
    asked = ("fit", lab / "0.csv", twin, lab / "2.csv", "--out", lab / "twins.npz")
    assert len(_COMMAND.figures(*asked)["levels"]) == 3
