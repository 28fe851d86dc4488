"""Tests of `reembody instrument`, which offers an instrument for a table of another tool."""

from pathlib import Path

import pytest

from app.protocol import load_instrument
from tests.cli.invoked import Invoked
from tests.features.results.imports.test_imports import QUALTRICS

_COMMAND = Invoked("instrument")
_SCORE = Invoked("score")


@pytest.fixture
def survey(tmp_path: Path) -> Path:
    """Return a survey of three items that no known instrument asks."""
    path = tmp_path / "survey.csv"
    path.write_text(QUALTRICS, encoding="utf-8")
    return path


def test_the_columns_are_named_and_an_instrument_is_written(survey: Path, tmp_path: Path) -> None:
    """Items, columns that are read and columns left out are named; the file scores the table."""
    out = tmp_path / "mood.yaml"
    found = _COMMAND.figures(
        survey, "--key", "mood", "--title", "Mood", "--maximum", "6", "--out", out
    )
    assert [one["column"] for one in found["offer"]["items"]] == ["Q1_1", "Q1_2", "Q1_3"]
    assert (found["offer"]["maximum"], found["offer"]["seen"]) == (6, "1 to 6")
    assert found["read"] == ["Participant", "Cond"]
    assert {one["name"]: one["filled"] for one in found["left_out"]}["Comment"] == 2
    table = tmp_path / "tidy.csv"
    table.write_text("who,q1_1,q1_2,q1_3\nP1,1,5,3\n", encoding="utf-8")
    scored = _SCORE.run(table, "--instrument", out)
    assert scored.stdout.splitlines()[-1].startswith("P1,3")


def test_the_text_says_what_was_seen(survey: Path) -> None:
    """The text names the offered items and counts what is left out."""
    text = _COMMAND.run(survey).stdout
    assert "Offered as own_scale" in text
    assert "I was tense" in text
    assert "Q2 (4)" in text


def _table(folder: Path, *columns: str) -> Path:
    """Write a table of people and columns, each given as `name a b c`."""
    cells = [["id", *(str(at) for at in range(len(columns[0].split(" ")) - 1))]]
    cells += [column.split(" ") for column in columns]
    path = folder / "table.csv"
    rows = zip(*cells, strict=True)
    path.write_text("\n".join(",".join(r).replace("_", " ") for r in rows) + "\n", encoding="utf-8")
    return path


def test_answers_seen_are_the_words_that_were_given(tmp_path: Path) -> None:
    """Only the words in the file are called seen, in the order of the scale that has them."""
    table = _table(tmp_path, "qa often sometimes never", "qb sometimes sometimes often")
    offered = _COMMAND.figures(table)["offer"]
    assert offered["seen"] == "“never”, “sometimes”, “often”"
    assert offered["labels"] == ["never", "rarely", "sometimes", "often", "always"]


def test_the_commonest_five_words_of_agreement_are_a_scale(tmp_path: Path) -> None:
    """Strongly disagree, disagree, neutral, agree, strongly agree are 1 to 5."""
    table = _table(tmp_path, "qa Strongly_agree Neutral Agree", "qb Disagree Agree Neutral")
    out = tmp_path / "own.yaml"
    offered = _COMMAND.figures(table, "--out", out)["offer"]
    assert (offered["minimum"], offered["maximum"], offered["labels"][2]) == (1, 5, "neutral")
    assert any("scales of 5 and of 7 steps" in doubt for doubt in offered["doubts"])
    scale = load_instrument(out.read_text(encoding="utf-8")).instrument.scale
    assert scale is not None
    assert [label["en"] for label in scale.labels][::4] == ["strongly disagree", "strongly agree"]


def test_words_that_no_known_scale_has_are_named(tmp_path: Path) -> None:
    """Without an offer, the refusal names the words that were seen and their column."""
    table = _table(tmp_path, "qa Meh Superb Meh", "qb Superb Meh Awful")
    refused = _COMMAND.refusal(table, "--out", tmp_path / "own.yaml")
    assert "qa: words that no known scale has: “Meh”, “Superb”" in refused
    assert "replace them with numbers" in _COMMAND.run(table).stdout


@pytest.mark.parametrize(
    ("columns", "ends", "words"),
    [
        (("qa 0 1 1", "qb 1 0 0"), (0, 1), "Only 0 and 1 were seen"),
        (("qa 4 4 4", "qb 4 4 4"), (1, 5), "Every answer is 4"),
        (("qa 2 3 4", "qb 4 2 3"), (1, 5), "its minimum of 1 and its maximum of 5"),
    ],
)
def test_a_guessed_scale_is_called_a_guess(
    tmp_path: Path, columns: tuple[str, ...], ends: tuple[int, int], words: str
) -> None:
    """Ends that nobody gave are a guess in text and file, with what makes it doubtful."""
    out = tmp_path / "own.yaml"
    table = _table(tmp_path, *columns)
    text = _COMMAND.run(table, "--out", out).stdout
    assert "The scale is a guess" in text
    assert "Confirm with --minimum and --maximum" in text
    assert words in text
    written = out.read_text(encoding="utf-8")
    made = load_instrument(written).instrument
    assert made.scale is not None
    assert (made.scale.minimum, made.scale.maximum) == ends
    assert "guessed from the answers seen" in made.provenance.verified
    assert "set by a person" not in written
    assert (
        "\n# Set both ends as the questionnaire has them, here and below `scores`.\nscale:\n"
        in written
    )


def test_ends_that_a_person_gives_are_no_guess(tmp_path: Path) -> None:
    """An end given as an option is set by a person, even where the guess was the same."""
    table, out = _table(tmp_path, "qa 2 3 4", "qb 4 2 3"), tmp_path / "own.yaml"
    one = _COMMAND.run(table, "--maximum", "7").stdout
    assert "Confirm with --minimum, as" in one
    both = _COMMAND.run(table, "--minimum", "1", "--maximum", "5", "--out", out).stdout
    assert "guess" not in both
    assert "Scale 1 to 5, set by a person." in out.read_text(encoding="utf-8")
    assert "guess" not in out.read_text(encoding="utf-8")


def test_a_number_for_missing_answers_is_the_reason_that_a_column_is_left_out(
    tmp_path: Path,
) -> None:
    """A column with 99 among answers of 1 to 7 is left out, and 99 is named as the reason."""
    table = _table(tmp_path, "qa 1 99 7 2", "qb 1 4 7 2", "qc 3 3 7 1")
    found = _COMMAND.figures(table)
    assert [one["column"] for one in found["offer"]["items"]] == ["qb", "qc"]
    (left,) = (one for one in found["left_out"] if one["name"] == "qa")
    assert left["reason"].startswith("99 in 1 cell, all others 1 to 7")
    assert "qa: 99 in 1 cell" in _COMMAND.run(table).stdout
    everywhere = _table(tmp_path, "qa 1 99 7", "qb 99 4 7", "qc 3 3 99")
    assert "99 is far from all other answers" in _COMMAND.run(everywhere).stdout


def test_the_file_is_written_as_lines_to_edit(survey: Path, tmp_path: Path) -> None:
    """The file has a setting on each line, without the brackets of JSON, and keeps odd texts."""
    out = tmp_path / "mood.yaml"
    _COMMAND.run(survey, "--title", "no: #1 - “Mood”", "--out", out)
    written = out.read_text(encoding="utf-8")
    assert load_instrument(written).instrument.title == {"en": "no: #1 - “Mood”"}
    assert "\n  minimum: 1\n  maximum: 7\n" in written
    assert "\n  - key: q1_1\n    type: likert\n" in written
    assert not written.startswith("{")


def test_an_empty_score_is_explained(survey: Path, tmp_path: Path) -> None:
    """A score without a value is counted on standard error, with the lines and the empty items."""
    out, table = tmp_path / "mood.yaml", tmp_path / "tidy.csv"
    _COMMAND.run(survey, "--out", out)
    table.write_text("who,q1_1,q1_2,q1_3\nP1,1,,3\nP2,1,2,3\nP3,,,3\n", encoding="utf-8")
    scored = _SCORE.run(table, "--instrument", out)
    assert scored.exit_code == 0
    assert scored.stdout.splitlines()[1] == "P1,"
    assert "2 of 3 rows have no mean_of_items" in scored.stderr
    assert "line 2 (q1_2), line 4 (q1_1, q1_2)" in scored.stderr
    table.write_text("who,q1_1,q1_2,q1_3\nP1,1,2,3\n", encoding="utf-8")
    assert _SCORE.run(table, "--instrument", out).stderr == ""


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["--key", "veq"], "no instrument has"), (["--minimum", "9"], "a minimum below the maximum")],
)
def test_what_cannot_be_an_instrument_is_refused(
    survey: Path, arguments: list[str], words: str
) -> None:
    """A key that is taken, and a scale without steps, are refused with what is valid."""
    assert words in _COMMAND.refusal(survey, *arguments)
