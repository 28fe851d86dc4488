"""Tests that all problems of an invalid study file are reported with place and remedy."""

import json
import re

import pytest

from app.protocol import ConfigError, load_instrument, parse_study_json
from app.resources import study_configs_dir
from tests.protocol.helpers import STUDY, edited, loaded, problems


@pytest.mark.parametrize(
    ("change", "path", "expected_message", "remedy"),
    [
        (
            ("replicates: 2", "replicates: 2\n  replicate: 3"),
            "orders.replicate",
            "not valid",
            "'replicates'",
        ),
        (
            ("limb_order: fixed", "limb_order: fixed\n    limb_ordr: x"),
            "procedure.block.limb_ordr",
            "not valid",
            "mean",
        ),
        (("latency_ms: 125", "latency_ms: -125"), "conditions[1].latency_ms", "negative", "0 for"),
        (
            ("latency_ms: 0, text", "latency_ms: -1, text"),
            "procedure.before[5].latency_ms",
            "neg",
            "",
        ),
        (("latency_ms: 125", "latency_ms: .nan"), "conditions[1].latency_ms", "finite", "number"),
        (
            ("latency_ms: 125", "latency_ms: '125'"),
            "conditions[1].latency_ms",
            "a number",
            "quotes",
        ),
        (
            ("latency_ms: 125", "latency_ms: ''"),
            "conditions[1].latency_ms",
            "A number is missing here.",
            "0 or more",
        ),
        (("replicates: 2", "replicates:"), "orders.replicates", "missing", "from 1 to 1000"),
        (
            ("duration_s: 60", "duration_s: ''"),
            "procedure.block.phases[0].duration_s",
            "A number is missing here.",
            "a number above 0",
        ),
        (
            ("latency_ms: 125", "latency_ms: 0"),
            "conditions[1].latency_ms",
            "both add 0 ms",
            "Change",
        ),
        (("key: latency_125", "key: latency_0"), "conditions[1].key", "Two conditions", "Rename"),
        (("replicates: 2", "replicates: 2\n  replicates: 3"), "orders.replicates", "twice", "Keep"),
        (("replicates: 2", "replicates: 0"), "orders.replicates", "out of range", "at least 1"),
        (("replicates: 2", "replicates: 1.5"), "orders.replicates", "whole number", ""),
        (("when_full: grow", "when_full: no"), "orders.when_full", "'no'", "grow, closed"),
        (("operator: ", "operator: yes #"), "blinding.operator", "true or false", "quotes"),
        (
            ("duration_s: 60", "duration_s: 0"),
            "procedure.block.phases[0].duration_s",
            "range",
            "above",
        ),
        (
            ("freeze_s: 5", "freeze_s: -5"),
            "procedure.block.phases[0].freeze_s",
            "range",
            "at least 0",
        ),
        (("duration_s: 120, ", ""), "procedure.before[5].duration_s", "missing", "seconds"),
        (("limb: foot", "limb: hand"), "procedure.block.phases", "two phases", "one phase"),
        (("step: height", "step: heigth"), "procedure.before[3].step", "heigth", "'height'"),
        (("step: height, ", ""), "procedure.before[3].step", "missing", "materialise"),
        (("text: t_pose", "text: tpose"), "procedure.before[4].text", "no text 'tpose'", "t_pose"),
        (
            ("instrument: demographics", "instrument: demo"),
            "procedure.before[1].instrument",
            "demo",
            "k",
        ),
        (("  freeze:\n", "  frozen:\n"), "texts.freeze", "missing", "every language"),
        (("    de: Bitte halten", "    fr: Bitte halten"), "texts.freeze.de", "'de'", "languages"),
        (("de: keine zus", "fr: keine zus"), "conditions[0].label.de", "'de'", ""),
        (
            ("    en: Please hold still for", "    en: 5 #"),
            "texts.freeze.en",
            "Expected text",
            "quotes",
        ),
        (("[-0.11, 1.2", "[-0.22, 1.2"), "tasks.hand", "overlap", ""),
        (("length_factor: 1.10", "length_factor: 2.5"), "tasks.foot", "overlap", ""),
        (("[-0.39, 0.07", "[-0.39, 0.02"), "tasks.foot", "below the floor", ""),
        (("sides: [left, right, top", "sides: [left, front, top"), "tasks.hand", "no side", ""),
        (("[0, 1.42, -0.55]", "[0, 1.42]"), "tasks.hand.target.center_m[2]", "after 2 values", ""),
        (
            ("undelayed_parts: [Hips]", "undelayed_parts: [Hip]"),
            "latency.undelayed_parts",
            "Hip",
            "",
        ),
        (("default: standard", "default: dark"), "appearance.default", "does not exist", "palette"),
        (('"#8a8f98"', "red"), "appearance.palettes[0].colours.panel", "'red'", "#rrggbb"),
        (("avatar: delayed_copy", "avatar: puppet"), "avatar", "'puppet'", "delayed_copy"),
        (("key: reembodiment-latency", "key: Re embody"), "key", "'Re embody'", "lower-case"),
        (("languages: [en, de]", "languages: [en, en]"), "languages", "twice", "once"),
    ],
)
def test_each_problem_has_its_place_and_its_remedy(
    change: tuple[str, str], path: str, expected_message: str, remedy: str
) -> None:
    """Each mistake gives one problem with its line, its path and a remedy."""
    text = edited(change)
    (problem,) = problems(text)
    assert problem.path == path
    assert expected_message in problem.message
    assert remedy in problem.remedy
    assert problem.line > 0
    assert problem.column > 0


def test_a_problem_points_at_its_line_and_value() -> None:
    """The problem of a negative latency points at the line of its value."""
    text = edited(("latency_ms: 350", "latency_ms: -350"))
    (problem,) = problems(text)
    assert text.splitlines()[problem.line - 1][problem.column - 1 :] == "-350"
    assert problem.value == -350
    assert problem.valid == "0 to 10000 ms"


def test_an_unknown_key_lists_the_valid_ones() -> None:
    """The problem of an unknown key lists the valid keys."""
    (problem,) = problems(edited(("when_full: grow", "full: grow\n  when_full: grow")))
    assert problem.valid == ["design", "replicates", "seed", "sequences", "when_full"]


def test_a_title_too_long_for_a_page_says_how_long_it_may_be() -> None:
    """A title of a study or an instrument may have 200 characters, in each language."""
    long = edited(("  en: Acting through another body", f"  en: {'x' * 201}"))
    (problem,) = problems(long)
    assert (problem.path, problem.message) == ("title.en", "The title (en) has 201 characters.")
    assert str(problem.value).startswith("xxx")
    assert problem.valid == "at most 200 characters"
    assert problem.remedy.startswith("Shorten it")
    assert loaded(long.replace("x" * 201, "x" * 200)).protocol.title["en"] == "x" * 200
    shipped = (study_configs_dir() / "instruments" / "fms.yaml").read_text(encoding="utf-8")
    wordy = re.sub(r"(?m)^title:\n  en: .*$", f"title:\n  en: {'x' * 201}", shipped)
    assert wordy != shipped
    with pytest.raises(ConfigError) as refused:
        load_instrument(wordy)
    assert [one.path for one in refused.value.problems] == ["title.en"]


def test_a_stored_study_with_a_long_title_stays_readable() -> None:
    """A study that was stored with a longer title, when there was no limit, can still be read."""
    stored = json.loads(loaded(STUDY).canonical_json)
    stored["title"]["en"] = "x" * 10_000
    assert parse_study_json(json.dumps(stored)).title["en"] == "x" * 10_000


@pytest.mark.parametrize(
    ("given", "valid"),
    [
        ("1" + 40 * "0", "at most 9007199254740991"),
        ("1e400", "at most 1.8e+308"),
    ],
)
def test_a_number_that_is_too_large_says_what_is_valid(given: str, valid: str) -> None:
    """A number that is too large is reported with the numbers that are valid."""
    (problem,) = problems(edited(("seed: 20200415", f"seed: {given}")))
    assert problem.path == "orders.seed"
    assert problem.message.endswith("is too large.")
    assert problem.valid == valid
    assert valid.rpartition(" ")[2] in problem.remedy


def test_a_missing_section_ends_with_one_full_stop() -> None:
    """The remedy for a missing section quotes its description, which ends with a full stop."""
    before, _, rest = STUDY.partition("provenance:\n")
    (problem,) = problems(before + re.sub(r"\A(?:[ ].*\n)+", "", rest))
    assert problem.path == "provenance"
    assert problem.remedy.endswith("how far they were verified.")
    assert ".." not in problem.remedy


def test_all_problems_are_reported_in_the_order_of_the_file() -> None:
    """Problems of values, references and sections are reported together, in the file's order."""
    text = edited(
        ("latency_ms: 125", "latency_ms: -1"),
        ("replicates: 2", "replicate: 2"),
        ("text: t_pose", "text: tpose"),
        ("duration_s: 60", "duration_s: .inf"),
        ("[-0.11, 1.2", "[-0.22, 1.2"),
        ("    de: Bitte halten", "    fr: Bitte halten"),
    )
    found = problems(text)
    assert [problem.path for problem in found] == [
        "conditions[1].latency_ms",
        "orders.replicates",
        "orders.replicate",
        "procedure.before[4].text",
        "procedure.block.phases[0].duration_s",
        "tasks.hand",
        "texts.freeze.de",
    ]
    lines = [problem.line for problem in found]
    assert lines == sorted(lines)
