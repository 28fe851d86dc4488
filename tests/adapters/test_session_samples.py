"""Tests of reading hands from samples that the product exported."""

import re
from pathlib import Path

import numpy as np
import pytest

from app.adapters.session_samples import (
    SamplesError,
    is_session_samples,
    read_session_samples,
)
from tests.cli.exported_samples import as_samples, poses_of_reaches
from tests.science.simulation.people import SKELETON, tip


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Provide the samples of a simulated person who reaches a few times."""
    path = tmp_path_factory.mktemp("samples") / "session.csv"
    path.write_text(as_samples(poses_of_reaches(1, 4)))
    return path


def test_tips_are_those_of_the_poses(exported: Path) -> None:
    """Finger tips come out where the simulated person had them, to the digits of the file."""
    assert is_session_samples(exported)
    session = read_session_samples(exported, SKELETON.stature_m)
    assert session.simulated
    (phase,) = session.phases
    expected = np.array([tip(pose, "Right") for pose in poses_of_reaches(1, 4)])
    assert np.abs(phase.tips_m[:, 1] - expected).max() < 1e-4


def test_flagged_frames_are_not_seen_and_phases_are_apart(exported: Path, tmp_path: Path) -> None:
    """A flagged frame has no tips; frames outside of phases are left out, and a phase is a run."""
    lines = exported.read_text().splitlines()
    titles = lines[0].split(",")
    rows = [line.split(",") for line in lines[1:]]
    rows[5][titles.index("flagged")] = "true"
    for number, row in enumerate(rows):
        row[titles.index("phase_id")] = "1" if number < 50 else "0" if number < 90 else "2"
    path = tmp_path / "flagged.csv"
    path.write_text("\n".join([lines[0], *map(",".join, rows)]) + "\n")
    first, second = read_session_samples(path, 1.75).phases
    assert (first.phase_id, len(first.times_s), second.phase_id) == (1, 50, 2)
    assert np.flatnonzero(np.isnan(first.tips_m).any(axis=(1, 2))).tolist() == [5]
    assert np.flatnonzero(np.isnan(first.hips_m).any(axis=1)).tolist() == [5]


def test_other_tables_are_refused(exported: Path, tmp_path: Path) -> None:
    """A table without a joint's columns, or without frames in a phase, is no session."""
    assert not is_session_samples(Path(__file__))
    text = exported.read_text()
    (tmp_path / "less.csv").write_text(text.replace("target_Head_qw", "something"))
    with pytest.raises(SamplesError, match="not samples as an export has them"):
        read_session_samples(tmp_path / "less.csv", 1.75)
    outside = re.sub(r"^(true,1,\d+,)7,", r"\g<1>0,", text, flags=re.MULTILINE)
    (tmp_path / "outside.csv").write_text(outside)
    with pytest.raises(SamplesError, match="no frame is in a phase"):
        read_session_samples(tmp_path / "outside.csv", 1.75)
