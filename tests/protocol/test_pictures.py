"""Pictures in a study's texts."""

import re
from pathlib import Path

import pytest

from app.protocol.cross import PICTURES
from tests.protocol.helpers import STUDY, edited, problems, study

DRAWN = Path(__file__).parents[2] / "frontend" / "src" / "shared" / "pictures.ts"


def test_every_picture_is_drawn_and_shown() -> None:
    """The pages know the names that the file may use, and the shipped study uses each of them."""
    listed = re.search(r"PICTURES = \[([^\]]*)\]", DRAWN.read_text(encoding="utf-8"))
    assert listed is not None
    assert tuple(re.findall(r'"(\w+)"', listed[1])) == PICTURES
    for name in PICTURES:
        assert STUDY.count(f"\n      ![{name}]\n") == 2


@pytest.mark.parametrize("name", ["t-pose", "T_pose", "", "photo.jpg"])
def test_a_picture_that_there_is_not_is_named(name: str) -> None:
    """With its place, and with those that there are."""
    (problem,) = problems(edited(("![equipment]", f"![{name}]")))
    assert problem.path == "texts.instructions.en"
    assert problem.message == f"There is no picture {name!r}."
    assert problem.valid == list(PICTURES)


def test_brackets_within_a_line_are_words() -> None:
    """Only a line of its own is a picture."""
    words = "Press [A]! Or ![B] now."
    assert words in study(("![equipment]", words)).texts["instructions"]["en"]
