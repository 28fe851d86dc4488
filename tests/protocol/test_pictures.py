"""Tests of pictures in a study's texts."""

import re
from pathlib import Path

import pytest

from app.protocol.cross import PICTURES
from tests.protocol.helpers import STUDY, edited, problems, study

DRAWN = Path(__file__).parents[2] / "frontend" / "src" / "shared" / "pictures.ts"


def test_every_picture_is_drawn_and_shown() -> None:
    """The pages draw every picture that a file may name, and the shipped study uses each."""
    listed = re.search(r"PICTURES = \[([^\]]*)\]", DRAWN.read_text(encoding="utf-8"))
    assert listed is not None
    assert tuple(re.findall(r'"(\w+)"', listed[1])) == PICTURES
    for name in PICTURES:
        assert STUDY.count(f"\n      ![{name}]\n") == 2


@pytest.mark.parametrize("name", ["t-pose", "T_pose", "", "photo.jpg"])
def test_an_unknown_picture_is_rejected(name: str) -> None:
    """An unknown picture raises an error that names its place and the existing ones."""
    (problem,) = problems(edited(("![equipment]", f"![{name}]")))
    assert problem.path == "texts.instructions.en"
    assert problem.message == f"There is no picture {name!r}."
    assert problem.valid == list(PICTURES)


def test_brackets_within_a_line_are_text() -> None:
    """Brackets within a line are text, since a picture has a line of its own."""
    words = "Press [A]! Or ![B] now."
    assert words in study(("![equipment]", words)).texts["instructions"]["en"]
