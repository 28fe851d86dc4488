"""Tests of `reembody figure`: bodies for anybody's proportions."""

from pathlib import Path

import pytest

from app.adapters.humanoids import read_humanoid
from app.science.avatar.body import figure_of
from tests.cli.invoked import Invoked

_COMMAND = Invoked("figure")


def test_a_body_has_the_measured_proportions(tmp_path: Path) -> None:
    """A body is as tall as asked, with the measured lengths, and readable."""
    out = tmp_path / "body.glb"
    printed = _COMMAND.run(
        *("--population", "female", "--stature-m", "1.65"),
        *("--segment", "thigh=0.41", "--segment", "shoulders=0.37", "--out", str(out)),
    )
    assert "female, 1.65 m" in printed.output
    figure = figure_of(read_humanoid(out.read_bytes()).humanoid)
    assert figure.segments_m["thigh"] == pytest.approx(0.41, abs=1e-6)
    assert figure.segments_m["shoulders"] == pytest.approx(0.37, abs=1e-6)
    assert (figure.notes, figure.absent) == ((), ())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--population", "robot"), "male, female, neutral are valid"),
        (("--stature-m", "165"), "give the body height in metres"),
        (("--segment", "thigh=1.2"), "does not fit the stature"),
        (("--segment", "neck=0.1"), "There is no segment 'neck'"),
        (("--segment", "thigh"), "as in thigh=0.41"),
    ],
)
def test_impossible_bodies_are_refused(
    arguments: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    """What no person has is refused in a sentence, and no file is written."""
    out = tmp_path / "body.glb"
    assert said in _COMMAND.refusal(*arguments, "--out", str(out))
    assert not out.exists()
