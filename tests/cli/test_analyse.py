"""Tests of `reembody analyse`: figures, tables, missing data and refusals."""

from itertools import permutations, product
from pathlib import Path

import pytest

from tests.cli.invoked import Invoked
from tests.science.statistics.published import pingouin_table

_COMMAND = Invoked("analyse")
_FACTOR = ("--subject", "person", "--within", "latency", "--measure", "score")
_SCORES = {"P1": (7, 6, 2), "P2": (6, 6, 3), "P3": (7, 5, 1), "P4": (5, 5, 2), "P5": (6, 4, 3)}


def _written(folder: Path, lines: list[str], name: str = "data.csv") -> Path:
    path = folder / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _lines(separator: str = ",") -> list[str]:
    """Return one row for each person and latency, with latencies out of order."""
    rows = [separator.join(("person", "latency", "score", "remark"))]
    for person, scores in _SCORES.items():
        by_latency = dict(zip((0, 125, 350), scores, strict=True))
        rows += [
            separator.join((person, str(latency), str(by_latency[latency]), "ok"))
            for latency in (350, 0, 125)
        ]
    return rows


def _six() -> list[str]:
    """Return the rows of six people, who are enough for intervals."""
    return [*_lines(), *(f"P6,{at},{value},ok" for at, value in ((350, 1), (0, 7), (125, 4)))]


def test_json_has_every_test_of_one_factor(tmp_path: Path) -> None:
    """The JSON of one factor has every test with its keys, and levels sorted by number."""
    figures = _COMMAND.figures(_written(tmp_path, _lines()), *_FACTOR)
    assert {"n", "design", "means", "friedman", "pairwise", "page", "rm_anova"} <= set(figures)
    assert figures["n"] == 5
    assert figures["design"]["within"] == [{"factor": "latency", "levels": ["0", "125", "350"]}]
    assert [one["mean"] for one in figures["means"]] == pytest.approx([6.2, 5.2, 2.2])
    friedman = figures["friedman"]
    assert {"statistic", "df", "p", "p_asymptotic", "kendall_w", "method"} <= set(friedman)
    assert (friedman["df"], friedman["method"]) == (2, "exact")
    assert friedman["p"] < friedman["p_asymptotic"] < 0.01
    pairs = figures["pairwise"]
    assert [(one["a"], one["b"]) for one in pairs] == [
        ("0", "125"),
        ("0", "350"),
        ("125", "350"),
    ]
    assert {"w", "p", "p_holm", "rank_biserial"} <= set(pairs[0])
    assert (pairs[1]["w"], pairs[1]["p"], pairs[1]["rank_biserial"]) == (0.0, 0.0625, 1.0)
    assert figures["page"]["p_falling"] < 0.01
    assert [one["effect"] for one in figures["rm_anova"]] == ["latency"]
    assert figures["warnings"] == []


def test_two_factors_give_the_published_anova_and_families(tmp_path: Path) -> None:
    """Pingouin's `rm_anova2` gives F of 33.852, 26.959 and 12.632, and four families of tests."""
    table = pingouin_table("rm_anova2")
    path = _written(tmp_path, [",".join(table[0]), *(",".join(row.values()) for row in table)])
    names = ("--subject", "Subject", "--within", "Metric", "--within", "Time")
    figures = _COMMAND.figures(path, *names, "--measure", "Performance", "--art")
    by_name = {one["effect"]: one for one in figures["rm_anova"]}
    assert by_name["Time"]["f"] == pytest.approx(33.85228, abs=5e-6)
    assert by_name["Metric"]["f"] == pytest.approx(26.95919, abs=5e-6)
    assert by_name["Metric:Time"]["f"] == pytest.approx(12.63227, abs=5e-6)
    assert [(one["factor"], one["at"]) for one in figures["families"]] == [
        ("Metric", {}),
        ("Time", {}),
        ("Metric", {"Time": "Post"}),
        ("Metric", {"Time": "Pre"}),
    ]
    assert figures["friedman"] == figures["families"][0]["friedman"]
    assert figures["families"][1]["page"] is None
    assert "contested" in figures["aligned_ranks"]["caution"]


def test_each_level_is_compared_with_the_reference(tmp_path: Path) -> None:
    """Each level is compared with the reference, adjusted for two; an unknown level is refused."""
    rows = [
        f"P{who},{level},{who % 3 - level // 200}" for who in range(9) for level in (0, 125, 350)
    ]
    path = _written(tmp_path, ["person,latency,score", *rows])
    planned = _COMMAND.figures(path, *_FACTOR, "--reference", "0.0")["against_reference"]
    assert (planned["reference"], planned["first_that_differs"]) == ("0", "350")
    assert [one["a"] for one in planned["comparisons"]] == ["125", "350"]
    assert planned["comparisons"][1]["p_holm"] == pytest.approx(2.0 * 2.0 / 2**9)
    text = _COMMAND.run(path, *_FACTOR, "--reference", "0").stdout
    assert "First level that differs from 0: 350" in text
    assert "there are: 0, 125, 350" in _COMMAND.refusal(path, *_FACTOR, "--reference", "90")


def test_the_text_output_has_means_tests_and_methods(tmp_path: Path) -> None:
    """The text output has means, each test on a line, and the method by which p was computed."""
    result = _COMMAND.run(_written(tmp_path, _lines()), *_FACTOR, "--art")
    assert result.exit_code == 0, result.output
    assert "score by latency (0, 125, 350): 5 of 5 subjects complete." in result.stdout
    assert "Kendall's W" in result.stdout
    assert "exact" in result.stdout
    assert "0 - 350" in result.stdout
    assert "GG eps" in result.stdout
    assert "contested" in result.stdout
    assert max(len(line) for line in result.stdout.splitlines()) <= 200


def test_the_trend_of_tied_answers_is_exact_given_the_ties(tmp_path: Path) -> None:
    """Page's p, printed and as JSON, are shares of all arrangements of the tied ranks, both ways.

    The tables without ties give another p, which is in the JSON under a name of its own.
    """
    answers = ((1, 1, 2), (1, 2, 3), (2, 1, 2))
    ranks = ((1.5, 1.5, 3.0), (1.0, 2.0, 3.0), (2.5, 1.0, 2.5))
    sums = [
        sum(place * rank for row in rows for place, rank in enumerate(row, start=1))
        for rows in product(*(permutations(row) for row in ranks))
    ]
    found = sum(place * rank for row in ranks for place, rank in enumerate(row, start=1))
    rises = sum(one >= found for one in sums) / len(sums)
    falls = sum(one <= found for one in sums) / len(sums)
    rows = [
        f"P{person},{latency},{answer}"
        for person, row in enumerate(answers)
        for latency, answer in zip((0, 125, 350), row, strict=True)
    ]
    path = _written(tmp_path, ["person,latency,score", *rows])
    page = _COMMAND.figures(path, *_FACTOR)["page"]
    assert (page["p"], page["p_falling"]) == pytest.approx((rises, falls))
    assert (page["p_given_ties"], page["p_falling_given_ties"]) == pytest.approx((rises, falls))
    assert page["p_by_tables"] != pytest.approx(rises)
    text = _COMMAND.run(path, *_FACTOR).stdout
    printed = f"p = {rises:.4f} that it rises, p = {falls:.4f} that it falls, exact given the ties"
    assert printed in text


def test_the_order_of_rows_and_the_separator_do_not_matter(tmp_path: Path) -> None:
    """The result does not depend on row order, separator, decimal commas or a byte order mark."""
    head, *rows = _lines()
    plain = _COMMAND.figures(_written(tmp_path, [head, *rows]), *_FACTOR)
    turned = _COMMAND.figures(_written(tmp_path, [head, *rows[::-1]]), *_FACTOR)
    german = [line.replace(";7;", ";7,0;") for line in _lines(";")]
    spreadsheet = _COMMAND.figures(
        _written(tmp_path, ["\ufeff" + german[0], *german[1:]]), *_FACTOR
    )
    assert spreadsheet.pop("read_as") == [
        "score has decimal commas in 2 rows: 7,0 in line 3 was read as 7.0"
    ]
    assert plain.pop("read_as") == []
    assert spreadsheet == plain
    for key in ("friedman", "pairwise", "page"):
        reported = [
            {name: value for name, value in one.items() if "ci" not in name}
            for one in ([plain[key]] if isinstance(plain[key], dict) else plain[key])
        ]
        repeated = [
            {name: value for name, value in one.items() if "ci" not in name}
            for one in ([turned[key]] if isinstance(turned[key], dict) else turned[key])
        ]
        assert repeated == reported


@pytest.mark.parametrize("removed", ["P5,350,3,ok", "P5,350,NA,ok", "P5,350,,ok"])
def test_a_missing_value_excludes_its_subject(tmp_path: Path, removed: str) -> None:
    """A missing value excludes its subject listwise (Friedman) and pairwise (Wilcoxon)."""
    lines = [line for line in _lines() if line != "P5,350,3,ok"]
    if "3" not in removed.split(",")[2]:
        lines.append(removed)
    figures = _COMMAND.figures(_written(tmp_path, lines), *_FACTOR)
    assert (figures["n"], figures["design"]["subjects"]) == (4, 5)
    assert [one["n"] for one in figures["pairwise"]] == [5, 4, 4]
    assert [one["n_left_out"] for one in figures["pairwise"]] == [0, 1, 1]
    assert figures["missing"]["left_out_listwise"] == ["P5"]
    assert figures["missing"]["cells"] == 1
    assert any("P5 lacks latency 350" in warning for warning in figures["warnings"])


def test_several_rows_of_a_cell_are_averaged_with_a_warning(tmp_path: Path) -> None:
    """Several rows of one cell are averaged, with a warning."""
    figures = _COMMAND.figures(_written(tmp_path, [*_lines(), *_lines()[1:]]), *_FACTOR)
    assert figures["n"] == 5
    assert [one["mean"] for one in figures["means"]] == pytest.approx([6.2, 5.2, 2.2])
    assert figures["missing"]["averaged_cells"] == 15
    assert any("15 of 15 cells have several values" in one for one in figures["warnings"])


def test_data_without_error_variance_have_no_f(tmp_path: Path) -> None:
    """Data without error variance get Friedman's test and a warning, but no F."""
    lines = ["person,latency,score"]
    lines += [f"P{who},{level},{who + level}" for who in range(4) for level in (0, 1, 3)]
    figures = _COMMAND.figures(_written(tmp_path, lines), *_FACTOR)
    assert figures["rm_anova"] == []
    assert figures["friedman"]["kendall_w"] == pytest.approx(1.0)
    assert any("same amount" in warning for warning in figures["warnings"])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("P3,125,5,ok", "P3,125,often,ok"), ("Line 10", "'score'", "'often'")),
        (("P3,125,5,ok", "P3,125,5"), ("Line 10", "3 cells", "header has 4")),
        (("P3,125,5,ok", "P2,125,6,ok"), ("Line 10 repeats line 7", "Remove one")),
        (("P3,125,5,ok", " ,125,5,ok"), ("Line 10", "'person'", "is not a name")),
        (("P3,125,5,ok", 'P3,125,"5,ok'), ("cannot be read", "Close every quote")),
        (("person,", "who,"), ("no column 'person'", "who, latency, score, remark")),
        (("remark", "score"), ("'score' occurs 2 times", "rename")),
    ],
)
def test_an_invalid_row_is_refused_by_its_line(
    tmp_path: Path, change: tuple[str, str], words: tuple[str, ...]
) -> None:
    """An invalid row is refused with its line, column and value, and exit code 2."""
    text = "\n".join(_lines())
    assert change[0] in text
    output = _COMMAND.refusal(_written(tmp_path, [text.replace(*change)]), *_FACTOR)
    assert all(word in output for word in words), output


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([""], "is empty"),
        ([",,"], "only empty cells"),
        (["person,latency,score"], "no row"),
        (["person,latency,score", "P1,0,1", "P1,125,2"], "only one subject, 'P1'"),
        (["person,latency,score", "P1,0,1", "P2,0,2"], "only one level, '0'"),
        (["person,latency,score", "P1,0,1", "P2,125,2"], "'P1', for example, lacks latency 125"),
        (
            ["person,latency,score", "P1,0,4", "P1,125,4", "P2,0,4", "P2,125,4"],
            "'score' is 4 in every cell",
        ),
    ],
)
def test_a_table_with_too_few_data_is_refused(tmp_path: Path, lines: list[str], words: str) -> None:
    """A table with too few data is refused with what is needed."""
    assert words in _COMMAND.refusal(_written(tmp_path, lines), *_FACTOR)


def test_invalid_files_and_factors_are_refused(tmp_path: Path) -> None:
    """A missing or binary file, three factors or a repeated column are refused."""
    assert "nowhere.csv" in _COMMAND.refusal(tmp_path / "nowhere.csv", *_FACTOR)
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00")
    assert "UTF-8" in _COMMAND.refusal(binary, *_FACTOR)
    path = _written(tmp_path, _lines())
    assert "one or two" in _COMMAND.refusal(
        path, *_FACTOR, "--within", "remark", "--within", "score"
    )
    assert "all be different" in _COMMAND.refusal(path, *_FACTOR, "--within", "latency")


_LONG = ["person,latency,limb,measure,score"] + [
    f"P{who},{latency},{limb},{measure},{base + who % 3 - latency // 200}"
    for who in range(6)
    for latency in (0, 125, 350)
    for limb in ("hand", "foot", "")
    for measure, base in (("agency", 5), ("ownership", 3))
]
_TWO_FACTORS = (*_FACTOR, "--within", "limb")


def test_conditions_choose_one_measure_of_a_long_table(tmp_path: Path) -> None:
    """Rows of other measures and of phases without a limb are left out, counted, and named."""
    path = _written(tmp_path, _LONG)
    figures = _COMMAND.figures(path, *_TWO_FACTORS, "--where", "measure=agency")
    assert (figures["rows_used"], figures["rows_left_out"]) == (36, 72)
    assert figures["rows_left_out_because"] == [
        {"reason": "not measure=agency", "rows": 54},
        {"reason": "no limb", "rows": 18},
    ]
    assert "18 rows have no limb and were left out" in figures["warnings"]
    hand = _COMMAND.figures(path, *_FACTOR, "--where", "measure=agency", "--where", "limb = hand")
    assert hand["rows_used"] == 18
    assert [one["mean"] for one in hand["means"]] == pytest.approx([6.0, 6.0, 5.0])


def test_a_condition_that_no_row_fulfils_is_refused(tmp_path: Path) -> None:
    """A condition without `=`, on an unknown column or without rows says what there is."""
    path = _written(tmp_path, _LONG)
    assert "COLUMN=VALUE" in _COMMAND.refusal(path, *_FACTOR, "--where", "agency")
    assert "no column 'kind'" in _COMMAND.refusal(path, *_FACTOR, "--where", "kind=1")
    refusal = _COMMAND.refusal(path, *_FACTOR, "--where", "measure=location")
    assert "there are: agency, ownership" in refusal


def test_names_have_a_trend_only_in_a_declared_order(tmp_path: Path) -> None:
    """Page's test over names runs in the declared order, and not at all without one."""
    scores = {"low": (4, 5, 4, 6), "middle": (3, 4, 2, 5), "high": (1, 2, 2, 3)}
    rows = [
        f"P{who},{load},{value}" for load, all_ in scores.items() for who, value in enumerate(all_)
    ]
    path = _written(tmp_path, ["person,load,score", *rows])
    factor = ("--subject", "person", "--within", "load", "--measure", "score")
    figures = _COMMAND.figures(path, *factor, "--reference", "low")
    assert figures["page"] is None
    assert figures["against_reference"]["first_that_differs"] is None
    assert any("names without an order" in warning for warning in figures["warnings"])
    declared = _COMMAND.figures(path, *factor, "--order", "load=low, middle, high")
    assert declared["design"]["within"][0]["levels"] == ["low", "middle", "high"]
    # All four order the levels alike but for one tie: L is near its least, 4 x 10.
    assert declared["page"]["statistic"] == 40.5
    assert declared["page"]["p_falling"] < 0.01
    assert "name each of its 3 levels once" in _COMMAND.refusal(
        path, *factor, "--order", "load=low,high"
    )
    assert "one of: load" in _COMMAND.refusal(path, *factor, "--order", "limb=hand,foot")


def test_a_test_without_differences_is_named_and_has_no_figures(tmp_path: Path) -> None:
    """Where two levels never differ, W, p and effect size are absent and the reason is given."""
    rows = [f"P{who},{at},{who + (at > 200)}" for who in range(5) for at in (0, 125, 350)]
    path = _written(tmp_path, ["person,latency,score", *rows])
    figures = _COMMAND.figures(path, *_FACTOR, "--reference", "0")
    equal, different = figures["pairwise"][0], figures["pairwise"][1]
    assert (equal["degenerate"], equal["p"], equal["w"]) == (
        "all 5 differences are zero",
        None,
        None,
    )
    assert (different["degenerate"], different["p"]) == (None, 0.0625)
    assert any("0 - 125: all 5 differences are zero" in one for one in figures["warnings"])
    text = _COMMAND.run(path, *_FACTOR, "--reference", "0").stdout
    assert "125 all 5 differences are zero" in text


def test_another_v_of_r_is_noted(tmp_path: Path) -> None:
    """Where R ranks equal differences apart, because 0.3 - 0.2 is not 0.2 - 0.1, its V is noted."""
    pairs = [(0.3, 0.2), (0.1, 0.2), (0.5, 0.1), (0.7, 0.2)]
    rows = [
        f"P{who},{at},{value}"
        for who, pair in enumerate(pairs)
        for at, value in zip((0, 125), pair, strict=True)
    ]
    figures = _COMMAND.figures(_written(tmp_path, ["person,latency,score", *rows]), *_FACTOR)
    # 0.3 - 0.2 = 0.09999999999999998 has rank 1 in R, and 0.1 - 0.2 rank 2: V = 1 + 3 + 4.
    assert figures["pairwise"][0]["w"] == 1.5
    assert any("R's wilcox.test gives V = 8 instead of 8.5" in one for one in figures["warnings"])


def test_several_measures_are_never_averaged(tmp_path: Path) -> None:
    """A long table of two scores is refused with how to choose one; each is analysed alone."""
    lines = ["person,latency,limb,score,value"]
    for person in range(6):
        for latency in (0, 125):
            for limb in ("hand", "foot", ""):
                lines.append(f"P{person},{latency},{limb},agency,{7 - latency / 50 - person % 2}")
                lines.append(f"P{person},{latency},{limb},ownership,{50 + latency + person}")
    path = _written(tmp_path, lines)
    asked = ("--subject", "person", "--within", "latency", "--within", "limb", "--measure", "value")
    refused = _COMMAND.refusal(path, *asked)
    assert "'agency' and 'ownership'" in refused
    assert "--where 'score=...'" in refused
    by_number = path.read_text().replace("agency", "3").replace("ownership", "4")
    other = _written(tmp_path, by_number.splitlines(), "numbers.csv")
    assert "--average 'score'" in _COMMAND.refusal(other, *asked)
    assert _COMMAND.figures(other, *asked, "--average", "score")["rows_used"] == 48
    figures = _COMMAND.figures(path, *asked, "--where", "score=agency")
    assert (figures["rows_used"], figures["rows_left_out"]) == (24, 48)
    assert max(one["mean"] for one in figures["means"]) <= 7.0
    limbs = next(one for one in figures["design"]["within"] if one["factor"] == "limb")
    assert limbs["levels"] == ["foot", "hand"]


def _limbs(tmp_path: Path, line: str, changed: str) -> Path:
    """Write both limbs of six people at two latencies, with one line changed or left out."""
    lines = [
        f"P{person},{latency},{limb},{person + latency / 50 + len(limb)}"
        for person in range(6)
        for latency in (0, 125)
        for limb in ("hand", "foot")
    ]
    place = next(at for at, one in enumerate(lines) if one.startswith(line))
    lines[place : place + 1] = [changed] if changed else []
    return _written(tmp_path, ["person,latency,limb,score", *lines])


@pytest.mark.parametrize("asked", [("--where", "limb=hand"), ("--average", "limb")])
def test_a_word_that_is_spelt_otherwise_is_asked_about(
    tmp_path: Path, asked: tuple[str, str]
) -> None:
    """A row of `Hand` is neither left out nor averaged without a word; the column is named."""
    path = _limbs(tmp_path, "P3,125,hand", "P3,125,Hand,5")
    figures = _COMMAND.figures(path, *_FACTOR, *asked)
    assert any("'Hand'" in one and "only in capitals" in one for one in figures["warnings"])
    assert figures["missing"]["averaged_over"] == (["limb"] if asked[0] == "--average" else [])


def test_people_whose_mean_is_of_one_limb_alone_are_named(tmp_path: Path) -> None:
    """With `--average`, a cell without its foot is no silent mean of the hand."""
    path = _limbs(tmp_path, "P4,0,foot", "")
    figures = _COMMAND.figures(path, *_FACTOR, "--average", "limb")
    assert any("P4 lack a value of limb" in one for one in figures["warnings"])
    whole = _COMMAND.figures(
        _limbs(tmp_path, "P4,0,foot", "P4,0,foot,8"), *_FACTOR, "--average", "limb"
    )
    assert not any("lack a value of" in one for one in whole["warnings"])


def test_words_that_tell_the_rows_of_a_cell_apart_are_never_averaged_silently(
    tmp_path: Path,
) -> None:
    """Two items in a column of any name are refused with its name and `--where`, even if one lacks.

    A column of words may be averaged over if asked; words that do not recur are remarks.
    """
    rows = [
        f"P{person},{latency},{item},{base + latency / 50 + person % 3}"
        for person in range(6)
        for latency in (0, 125, 350)
        for item, base in (("agency", 100), ("ownership", 0))
    ]
    path = _written(tmp_path, ["person,latency,kind,score", *rows[:-1]])
    refused = _COMMAND.refusal(path, *_FACTOR)
    assert "Column 'kind'" in refused
    assert "agency, ownership" in refused
    assert "--where 'kind=...'" in refused
    alone = _COMMAND.figures(path, *_FACTOR, "--where", "kind=agency")
    assert alone["means"][0]["mean"] == pytest.approx(101.0)
    over = _COMMAND.figures(path, *_FACTOR, "--average", "kind")
    assert over["means"][0]["mean"] == pytest.approx(51.0)
    assert any("their mean was taken" in one for one in over["warnings"])
    twice = [",".join((row, "A" if "agency" in row else "B")) for row in rows]
    path = _written(tmp_path, ["person,latency,kind,score,letter", *twice])
    assert "'letter'" not in _COMMAND.run(path, *_FACTOR, "--average", "kind").output
    path = _written(tmp_path, ["person,latency,kind,score", *rows])
    assert "no column 'item'" in _COMMAND.refusal(path, *_FACTOR, "--average", "item")
    remarks = [line.replace("agency", f"at {at}").replace("ownership", f"at {at}")
               for at, line in enumerate(rows)]  # fmt: skip
    path = _written(tmp_path, ["person,latency,kind,score", *remarks])
    assert _COMMAND.figures(path, *_FACTOR)["missing"]["averaged_cells"] == 18


def test_measures_coded_by_numbers_are_not_pooled(tmp_path: Path) -> None:
    """A crossed column of numbers is refused as words are; one that counts trials is named."""
    rows = [
        f"P{person},{latency},{code},{100 * code + latency / 50 + person % 3}"
        for person in range(6)
        for latency in (0, 125, 350)
        for code in (1, 2)
    ]
    for name in ("scale", "kind"):
        path = _written(tmp_path, [f"person,latency,{name},score", *rows])
        refused = _COMMAND.refusal(path, *_FACTOR)
        assert f"Column {name!r} tells the values of each cell apart: 1, 2" in refused
        assert f"--average {name!r}" in refused
        over = _COMMAND.figures(path, *_FACTOR, "--average", name)
        assert over["missing"]["averaged_over"] == [name]
        assert any(f"their mean was taken, over {name}" in one for one in over["warnings"])
    path = _written(tmp_path, ["person,latency,trial_number,score", *rows])
    trials = _COMMAND.figures(path, *_FACTOR)
    assert trials["missing"]["averaged_over"] == ["trial_number"]


def test_participants_that_differ_only_in_capitals_are_asked_about(tmp_path: Path) -> None:
    """P1 and p1 are analysed as two, and the first note asks whether they are one person."""
    lines = [*_lines(), *(line.replace("P1", "p1") for line in _lines() if "P1" in line)]
    first = _COMMAND.figures(_written(tmp_path, lines), *_FACTOR)["warnings"][0]
    assert "person P1 and p1 differ only in capitals: one person?" in first
    text = _COMMAND.run(_written(tmp_path, lines), *_FACTOR).output.splitlines()
    assert text[1].startswith("Note: person P1 and p1")


@pytest.mark.parametrize("code", ["-99", "99", "999.0"])
def test_a_usual_code_for_missing_far_from_all_other_values_is_noted(
    tmp_path: Path, code: str
) -> None:
    """A -99 among answers of 1 to 7 is noted with its line, and a 99 among percentages is not."""
    lines = _lines()
    lines[2] = f"P1,0,{code},ok"
    noted = _COMMAND.figures(_written(tmp_path, lines), *_FACTOR)["warnings"]
    assert any(f"score is {float(code):g} in line 3, far" in one for one in noted)
    text = _COMMAND.run(_written(tmp_path, lines), *_FACTOR).stdout
    assert "(1 to 6); it was used as a number" in text or "(1 to 7); it was used" in text
    rows = [
        f"P{who},{at},{90 + who + (at > 0) * (4 - who % 2)}" for who in range(10) for at in (0, 125)
    ]
    shares = _written(tmp_path, ["person,latency,score", *rows])
    assert ",99\n" in shares.read_text()
    assert _COMMAND.figures(shares, *_FACTOR)["warnings"] == []


def _with_level(rows: list[str], person: str, was: str, now: str) -> list[str]:
    return [row.replace(f",{was},", f",{now},") if row.startswith(f"{person},") else row
            for row in rows]  # fmt: skip


def test_a_level_that_was_mistyped_once_is_named(tmp_path: Path) -> None:
    """One row of 1255 instead of 125 leaves nobody complete: the error names its line."""
    path = _written(tmp_path, _with_level(_lines(), "P2", "125", "1255"))
    told = _COMMAND.refusal(path, *_FACTOR)
    assert "latency '1255' is only in line 7 (P2)" in told.splitlines()[0]
    assert "As it is, only 0 of 5 subjects" in told
    assert "for example" not in told
    assert "was '125' meant" in told
    assert "correct the file" in told


def test_a_rare_level_is_noted_where_enough_people_are_complete(tmp_path: Path) -> None:
    """In 30 people two have a level of their own beside all others: it is noted, and analysed."""
    rows = [f"P{who},{level},{who % 5 + at}" for who in range(30)
            for at, level in enumerate(("low", "mid", "high"))]  # fmt: skip
    extra = [f"P{who},hihg,{who}" for who in (3, 4)]
    path = _written(tmp_path, ["person,latency,score", *rows, *extra])
    notes = _COMMAND.figures(path, *_FACTOR)["warnings"]
    assert any("latency 'hihg' is only in line 92 (P3), 93 (P4)" in note for note in notes)
    assert any("was 'high' meant" in note for note in notes)
    plain = _COMMAND.figures(_written(tmp_path, ["person,latency,score", *rows]), *_FACTOR)
    assert not any("meant" in note or "mistyped" in note for note in plain["warnings"])


def test_a_rare_spelling_is_asked_about_once_with_its_line(tmp_path: Path) -> None:
    """`Hand` in one row is one question, which names the line, and not a second on its spelling."""
    rows = [f"P{who},{limb},{who % 3 + at}" for who in range(6)
            for at, limb in enumerate(("hand", "foot"))]  # fmt: skip
    path = _written(tmp_path, ["person,limb,score", *rows, "P3,Hand,2"])
    options = ("--subject", "person", "--within", "limb", "--measure", "score")
    told = _COMMAND.refusal(path, *options)
    assert "limb 'Hand' is only in line 14 (P3)" in told
    assert "was 'hand' meant" in told
    assert "differ only in capitals" not in told


def test_a_code_of_missing_values_is_named_and_can_be_declared(tmp_path: Path) -> None:
    """-99 is used as a number and doubted; with --missing it is an empty cell."""
    path = _written(tmp_path, [row.replace("P5,0,6", "P5,0,-99.0") for row in _lines()])
    plain = _COMMAND.figures(path, *_FACTOR)
    assert any("say so with --missing -99" in note for note in plain["warnings"])
    declared = _COMMAND.figures(path, *_FACTOR, "--missing", "-99")
    assert declared["n"] == plain["n"] - 1
    emptied = _COMMAND.figures(
        _written(tmp_path, [row.replace("P5,0,6", "P5,0,") for row in _lines()]), *_FACTOR
    )
    assert declared["means"] == emptied["means"]


def test_a_contrast_has_one_interval_whatever_else_is_asked(tmp_path: Path) -> None:
    """The interval of 0 - 125 is the same with and without the rows of 350."""
    path = _written(tmp_path, _six())
    whole = _COMMAND.figures(path, *_FACTOR)["pairwise"][0]
    two = [row for row in _six() if ",350," not in row]
    alone = _COMMAND.figures(_written(tmp_path, two, "two.csv"), *_FACTOR)["pairwise"][0]
    assert whole["mean_difference_ci"] == alone["mean_difference_ci"] is not None


def test_levels_spelt_almost_alike_are_asked_about(tmp_path: Path) -> None:
    """`125 ms` and `125ms`, each of half of the rows, are asked about; 0 and 0.0 are one."""
    rows = [
        f"P{who},{level},{who % 3 + at}"
        for who in range(6)
        for at, level in enumerate(("0 ms", "125 ms" if who % 2 else "125ms"))
    ]
    told = _COMMAND.refusal(_written(tmp_path, ["person,latency,score", *rows]), *_FACTOR)
    assert "latency '125 ms' and '125ms' differ only in capitals, spaces or dashes" in told
    assert "spell them alike" in told
