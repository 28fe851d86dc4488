"""Tests of what `reembody analyse` doubts: decimal signs, people, codes, orders, few people."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from app.cli.analyse.decimals import read_numbers
from app.cli.analyse.doubts import missing_codes, split_decimals
from app.cli.analyse.inputs import TidyInput, read_tidy
from app.cli.analyse.people import alike_subjects, same_people, summary_rows
from app.science.statistics import UnusableTable, cells_of
from tests.cli.invoked import Invoked

_COMMAND = Invoked("analyse")
_FACTOR = ("--subject", "person", "--within", "latency", "--measure", "score")


def _written(folder: Path, lines: list[str], header: str = "person,latency,score") -> Path:
    path = folder / "data.csv"
    path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
    return path


def _read(folder: Path, lines: list[str], header: str = "person,latency,score") -> TidyInput:
    return read_tidy(_written(folder, lines, header), "person", ["latency"], "score")


def _of(measure: list[str]) -> TidyInput:
    """Return a table with these values of the measure, in lines 2 and on."""
    size = len(measure)
    people = [f"P{at}" for at in range(size)]
    return TidyInput(people, {"latency": ["0"] * size}, measure, list(range(2, 2 + size)), 0, {})


@pytest.mark.parametrize(
    ("cells", "separator", "words"),
    [
        (["734,5", "843,7", "1.164"], ";", ("1.164 in line 4", "734,5 in line 2", "Write 1164")),
        (["734", "844", "1,164"], ";", ("1,164 in line 4", "734 in line 2", "or 1,1640 if")),
        (["1.164", "0", "932"], ",", ("1.164 in line 2", "932 in line 4", "1164 or 1.164")),
        (["12.345", "8.900", "734,5"], ";", ("12.345 in line 2", "2 of its cells")),
        (["0", "0,5", "1.000"], ";", ("1.000 in line 4", "0,5 in line 3")),
    ],
)
def test_a_sign_that_may_separate_thousands_is_refused(
    cells: list[str], separator: str, words: tuple[str, ...]
) -> None:
    """1.164 beside 734,5 and 1,164 beside 734 are a thousand or a decimal: neither is chosen."""
    with pytest.raises(UnusableTable) as refused:
        read_numbers("score", cells, [2, 3, 4], separator)
    assert all(word in str(refused.value) for word in words), str(refused.value)


@pytest.mark.parametrize(
    ("cells", "separator"),
    [
        (["1.164", "0.932", "2.5"], ","),
        (["1.164", "2", "3"], ","),
        (["1,1640", "734", "844"], ";"),
        (["12", "7.125", "8.250"], "\t"),
    ],
)
def test_decimals_among_numbers_of_their_size_are_read(cells: list[str], separator: str) -> None:
    """Three decimals beside numbers of the same size, or a fourth digit, are decimals."""
    read = read_numbers("score", cells, [2, 3, 4], separator)
    assert read.cells == [cell.replace(",", ".") for cell in cells]
    assert read.doubts == ()


def test_decimal_signs_that_are_mixed_or_all_before_three_digits_are_doubted() -> None:
    """3,96 beside 4.32, and nothing but 1.396 between semicolons, are read and doubted."""
    mixed = read_numbers("score", ["3,96", "4.32"], [2, 3], ";")
    assert mixed.cells == ["3.96", "4.32"]
    assert "3,96 in line 2) and decimal points (1, such as 4.32 in line 3)" in mixed.doubts[0]
    assert mixed.read_as == ("score has decimal commas in 1 row: 3,96 in line 2 was read as 3.96",)
    thousands = read_numbers("score", ["1.396", "1.368"], [2, 3], ";")
    assert "If 1396 is meant" in thousands.doubts[0]
    assert read_numbers("score", ["1.396", "1.368"], [2, 3], ",").doubts == ()


@pytest.mark.parametrize(
    ("other", "words"),
    [
        ("P-1", "dashes"),
        ("P 1", "spaces"),
        ("p01", "leading zeros"),
        ("P_1", "P1 and P_1"),
    ],
)
def test_one_person_under_two_spellings_is_asked_about(
    tmp_path: Path, other: str, words: str
) -> None:
    """P1 and P-1, P 1 or p01 may be one person: the question names their lines."""
    rows = [f"P1,0,{at}" for at in (1, 2)]
    asked = alike_subjects(_read(tmp_path, ["P2,0,4", rows[0], f"{other},125,2"]), "person")
    assert len(asked) == 1
    assert words in asked[0]
    assert "line 3 and 4" in asked[0]


def test_numbers_and_letters_of_one_name_are_asked_about(tmp_path: Path) -> None:
    """1, 01 and 1.0 are one number, and a letter with its mark may be one character or two."""
    numbers = alike_subjects(_read(tmp_path, ["1,0,4", "01,0,4", "1.0,0,2", "10,0,1"]), "person")
    assert "1 and 01 and 1.0 differ only in how one number is written" in numbers[0]
    assert "analysed as 3" in numbers[0]
    encoded = alike_subjects(_read(tmp_path, ["M\u00fcller,0,4", "Mu\u0308ller,0,2"]), "person")
    assert "Unicode" in encoded[0]
    others = ["1-2,0,1", "12,0,1", "P1,0,3", "P10,0,4", "Q1,0,1", "P11,0,2"]
    assert alike_subjects(_read(tmp_path, others), "person") == []


def test_nobody_complete_for_a_spelling_is_refused_with_it(tmp_path: Path) -> None:
    """Where 01 has the rows that 1 lacks, the refusal says so first."""
    rows = [f"{f'0{who}' if at else who},{at},{who + at}" for who in range(1, 5) for at in (0, 125)]
    told = _COMMAND.refusal(_written(tmp_path, rows), *_FACTOR)
    assert "person 1 and 01; 2 and 02; 3 and 03; 4 and 04 differ only in how" in told
    assert "As it is, only 0 of 8 subjects" in told


def test_rows_of_a_summary_are_asked_about(tmp_path: Path) -> None:
    """`Mean`, `SD (n-1)` and `Mittelwert` are no people; Max and S1 are left alone."""
    rows = [f"{who},0,4" for who in ("Max", "S1", "Mean", "SD (n-1)", "Mittelwert:", "Summer")]
    asked = summary_rows(_read(tmp_path, rows), "person")
    assert [one.split(" looks")[0] for one in asked] == [
        "person 'Mean' in line 4",
        "person 'SD (n-1)' in line 5",
        "person 'Mittelwert:' in line 6",
    ]


def test_copied_people_are_asked_about_unless_answers_are_coarse() -> None:
    """Two people with 4.36, 2.69 and 1.3 are asked about, two with 7, 6 and 2 of seven are not."""

    def asked(rows: Sequence[tuple[float, ...]]) -> list[str]:
        people = [f"P{at}" for at, row in enumerate(rows) for _ in row]
        levels = [str(level) for row in rows for level in range(len(row))]
        values = [value for row in rows for value in row]
        return same_people(cells_of(people, {"latency": levels}, values), "person")

    fine = [(4.36, 2.69, 1.3), (5.34, 3.11, 0.87), (4.36, 2.69, 1.3), (3.9, 2.2, 1.01)]
    assert asked(fine)[0].startswith("person P0 and P2 have exactly the same values")
    assert asked(fine[:2]) == []
    coarse = [(7.0, 6.0, 2.0), (1.0, 5.0, 3.0), (7.0, 6.0, 2.0)]
    assert asked(coarse) == []
    assert asked([(5.0, 5.0, 5.0), (5.0, 5.0, 5.0), (4.01, 3.02, 5.03)]) == []


def test_decimals_that_went_into_the_next_column_are_asked_about(tmp_path: Path) -> None:
    """4,36 between commas fills a column for notes: asked about; a second score is left alone."""
    rows = ["P1,0,4,36", "P1,125,2,7", "P2,0,3,9"]
    header = "person,latency,score,"
    asked = split_decimals("score", _read(tmp_path, rows, header + "note"))
    assert "line 2 has 4 in score and 36 in 'note'" in asked[0]
    assert "is it 4,36" in asked[0]
    assert split_decimals("score", _read(tmp_path, rows, header + "ownership")) == []
    words = [*rows, "P2,125,4,late"]
    assert split_decimals("score", _read(tmp_path, words, header + "note")) == []
    ragged = _COMMAND.refusal(_written(tmp_path, rows), *_FACTOR)
    assert "If numbers have decimal commas" in ragged


@pytest.mark.parametrize(
    ("measure", "code", "said"),
    [
        (["0.5", "4", "5.9", "-8"], "-8", "far from all other values"),
        (["0.5", "4", "5.9", "-1"], "-1", "negative beside all other values"),
        (["1", "4", "7", "888"], "888", "far from all other values"),
        (["0", "4", "6", "-1"], None, ""),
        (["-3", "4", "6", "-1"], None, ""),
    ],
)
def test_codes_of_other_programs_are_doubted(
    measure: list[str], code: str | None, said: str
) -> None:
    """-8, 888 and a -1 beside positive numbers are doubted; a -1 beside 0 or -3 is a number."""
    found = missing_codes("score", _of(measure))
    assert len(found) == (code is not None)
    assert not found or (said in found[0] and f"--missing {code}" in found[0])


def test_every_doubt_reaches_the_output(tmp_path: Path) -> None:
    """One table with a slip of each kind has a note on each, before the figures where it is first.

    An order that contradicts the numbers and a code that stands nowhere are noted, too.
    """
    rows = [f"P{who};{at};{who}.{who}{who + at // 125}" for who in range(1, 6) for at in (0, 125)]
    rows += [f"P6;{at};1.1{at // 125 + 1}" for at in (0, 125)] + ["Mean;0;3,3", "Mean;125;3,4"]
    path = _written(tmp_path, [row.replace("P6", "P01") for row in rows], "person;latency;score")
    asked = (*_FACTOR, "--order", "latency=125,0", "--missing", "-99")
    figures = _COMMAND.figures(path, *asked)
    for words in (
        "person P1 and P01 differ only in",
        "person 'Mean' in line 14, 15",
        "have exactly the same values",
        "decimal commas (2, such as 3,3 in line 14)",
        "the declared order 125, 0 is not that of the numbers (0, 125)",
        "--missing -99 stands in no cell",
    ):
        assert any(words in one for one in figures["warnings"]), words
    text = _COMMAND.run(path, *asked).stdout.splitlines()
    assert "Read: score has decimal commas in 2 rows: 3,3 in line 14 was read as 3.3." in text


def test_few_people_have_wide_intervals(tmp_path: Path) -> None:
    """Three differences of 1, 2 and 3 have the interval 2 +- 4.303 / sqrt(3), one person has none.

    4.303 is the 97.5 % point of Student's t with two degrees of freedom, as in any table of it.
    """
    rows = [f"P{who},{at},{who * at / 125}" for who in (1, 2, 3) for at in (0, 125)]
    path = _written(tmp_path, rows)
    (pair,) = _COMMAND.figures(path, *_FACTOR)["pairwise"]
    assert pair["mean_difference"] == pytest.approx(-2.0)
    reach = 4.3027 / 3**0.5
    ends = (pair["mean_difference_ci"][one] for one in ("low", "high"))
    assert tuple(ends) == pytest.approx((-2.0 - reach, -2.0 + reach), abs=1e-4)


def test_differences_that_only_rounding_makes_zero_are_called_so(tmp_path: Path) -> None:
    """A billion and a millionth are equal to 11 digits: the note says that they are not equal."""
    rows = [f"P{who},{at},{1e9 + who + at * 1e-6:.6f}" for who in range(6) for at in (0, 125)]
    figures = _COMMAND.figures(_written(tmp_path, rows), *_FACTOR)
    assert figures["pairwise"][0]["degenerate"] == (
        "all 6 differences are zero to 11 digits, though 6 of the pairs are not equal"
    )
    assert any("rank the values as they are" in one for one in figures["warnings"])
    assert figures["friedman"]["kendall_w"] == 1.0


def test_numbers_without_a_square_are_refused(tmp_path: Path) -> None:
    """1e308 has no variance: it is refused with its line instead of a warning of a library."""
    rows = [f"P{who},{at},{1 + who + at}e307" for who in range(3) for at in (0, 125)]
    told = _COMMAND.refusal(_written(tmp_path, rows), *_FACTOR)
    assert "Line 2, column 'score': 1e+307 is beyond 1e+150" in told
    assert "RuntimeWarning" not in told
