"""Tests of loading a study file: one hash for one content, and all problems together."""

import dataclasses
import json
import re

import pytest
import yaml
from pydantic import ValidationError

from app.protocol import (
    ConfigError,
    StudyProtocol,
    load_instrument,
    load_study,
    parse_instrument_json,
    parse_study_json,
)
from tests.protocol.helpers import (
    CONFIGS,
    STUDY,
    edited,
    instruments,
    loaded,
    problems,
    study,
    with_levels,
)

KARAS = (CONFIGS / "instruments" / "karas2020.yaml").read_text(encoding="utf-8")


def reordered(value: object) -> object:
    """Return the same content with every mapping's keys reversed."""
    if isinstance(value, dict):
        return {key: reordered(value[key]) for key in reversed(value)}
    return [reordered(one) for one in value] if isinstance(value, list) else value


def test_the_hash_names_the_content_and_not_its_formatting() -> None:
    """Comments, key order, quoting, flow style, 60 for 60.0 and a BOM do not change the hash."""
    content_hash = loaded().content_hash
    tree = reordered(yaml.safe_load(STUDY))
    rewritten = yaml.safe_dump(
        tree, sort_keys=False, allow_unicode=True, default_style='"', width=60
    )
    plain = re.sub(r'"(-?[0-9.]+|true|false)"', r"\1", re.sub(r"!!\w+ ", "", rewritten))
    for text in (
        "# a remark\n" + STUDY,
        "\ufeff" + STUDY.replace("\n", "\r\n"),
        STUDY.replace("duration_s: 60", "duration_s: 60.0"),
        json.dumps(tree),
        plain,
    ):
        assert loaded(text).content_hash == content_hash


def test_every_change_of_content_changes_the_hash() -> None:
    """Changes of numbers, orders and single letters of a text change the hash."""
    changes = [
        ("latency_ms: 350", "latency_ms: 351"),
        ("replicates: 2", "replicates: 3"),
        ("Please wait a moment", "Please wait one moment"),
        ("[left, right, top, bottom]", "[right, left, top, bottom]"),
    ]
    hashes = {loaded(edited(change)).content_hash for change in changes}
    assert len({loaded().content_hash, *hashes}) == 1 + len(changes)


def test_only_what_decides_balance_changes_the_design_hash() -> None:
    """Conditions and orders change the design hash; labels and texts do not."""
    design = study().design_hash
    assert study(("125 ms added", "slow")).design_hash == design
    assert study(("duration_s: 60", "duration_s: 90")).design_hash == design
    assert study(("latency_ms: 125", "latency_ms: 130")).design_hash != design
    assert study(("seed: 20200415", "seed: 1")).design_hash != design


def test_the_canonical_json_gives_the_same_study() -> None:
    """A study restored from its canonical JSON is equal and has the same canonical JSON."""
    rewritten = parse_study_json(loaded().canonical_json)
    assert rewritten == loaded().protocol
    instrument = load_instrument(KARAS)
    assert parse_instrument_json(instrument.canonical_json) == instrument.instrument
    assert load_instrument(instrument.canonical_json).content_hash == instrument.content_hash


def test_a_study_cannot_be_changed() -> None:
    """Protocols and instruments are immutable."""
    with pytest.raises(ValidationError):
        study().key = "other"  # type: ignore[misc]  # frozen, that is the point
    with pytest.raises(dataclasses.FrozenInstanceError):
        load_instrument(KARAS).instrument.version = 2  # type: ignore[misc]  # frozen, that is the point


def test_six_levels_make_720_rows_and_seven_are_too_many() -> None:
    """All orders of six conditions are allowed; the 5040 of seven are too many."""
    assert len(loaded(with_levels(6)).protocol.conditions) == 6
    (problem,) = problems(with_levels(7))
    assert problem.path == "orders.design"
    assert "5040" in problem.message
    assert "720" in str(problem.valid)


def test_an_instrument_must_speak_the_languages_of_the_study() -> None:
    """An instrument that lacks a language of the study is rejected at each use."""
    english = load_instrument(KARAS.replace("languages: [en, de]", "languages: [en]")).instrument
    with pytest.raises(ConfigError) as caught:
        load_study(STUDY, instruments={**instruments(), "karas2020": english})
    assert {problem.path for problem in caught.value.problems} == {
        "procedure.block.phases[0].questionnaire",
        "procedure.block.phases[1].questionnaire",
    }
    assert "'de'" in caught.value.problems[0].message


def test_a_study_in_another_language_brings_its_own_titles() -> None:
    """A study in a third language must have titles of its own, as built-in ones are en and de."""
    found = problems(edited(("languages: [en, de]", "languages: [fr]")))
    assert "procedure.block.phases[0].questionnaire_title" in [one.path for one in found]


@pytest.mark.parametrize("text", ["- a\n- b\n", "hello\n", "3\n"])
def test_a_file_that_is_no_mapping_is_rejected(text: str) -> None:
    """A study or instrument file that is not a mapping is rejected."""
    for load in (loaded, load_instrument):
        with pytest.raises(ConfigError, match="not a mapping"):
            load(text)


def test_an_instrument_names_formula_and_unknown_key_at_once() -> None:
    """An unknown key does not hide the problem of a formula."""
    text = KARAS.replace("q6 + q7 + q8 - q9", "q6 + q77").replace("shuffle:", "shufle:")
    with pytest.raises(ConfigError) as caught:
        load_instrument(text)
    first, second = caught.value.problems
    assert (first.path, second.path) == ("shufle", "scores[1].formula")
    assert "Did you mean 'shuffle'" in first.remedy
    assert "character 6" in second.message
    assert "Did you mean q7" in second.remedy
    assert text.splitlines()[second.line - 1].strip() == "formula: q6 + q77"


def test_a_damaged_stored_study_is_rejected() -> None:
    """A damaged study in the database raises a clear error."""
    with pytest.raises(ConfigError):
        parse_study_json('{"key": 1}')
    with pytest.raises(ConfigError):
        parse_instrument_json("not json")


def test_of_thousands_of_problems_the_first_are_explained() -> None:
    """A file of another kind has thousands of problems: they are counted, two hundred explained."""
    text = STUDY + "".join(f"key_{number}: 1\n" for number in range(3000))
    with pytest.raises(ConfigError) as caught:
        load_study(text, instruments={})
    assert len(caught.value.problems) < 300
    assert "There are 3000 problems; the first 200 are listed." in str(caught.value)


def test_problems_are_serialised_as_json() -> None:
    """Problems can be serialised as JSON for the console."""
    (problem,) = problems(edited(("replicates: 2", "replicates: 0")))
    assert json.loads(json.dumps(problem.as_json()))["path"] == "orders.replicates"
    assert isinstance(loaded().protocol, StudyProtocol)
