"""Tests of the instrument library over HTTP: reading, checking, storing versions and scoring."""

import pytest

from app.resources import study_configs_dir
from tests.features.lab import STUDY, Json, Lab, error, ok

OWN = """
key: calm
version: 1
title: {en: Calm, de: Ruhe}
languages: [en, de]
provenance: {source: ours, licence: ours, verified: nothing}
scale: {minimum: 1, maximum: 5, labels: []}
recode: x - 3
items:
  - {key: calm, type: likert, text: {en: I felt calm., de: Ich war ruhig.}}
  - {key: tense, type: likert, text: {en: I felt tense., de: Ich war angespannt.}}
  - {key: note, type: text, required: false, text: {en: "Why?", de: "Warum?"}}
scores:
  - {key: ease, label: {en: Ease, de: Gelassenheit}, formula: (calm - tense) / 2}
  - {key: twice, label: {en: Twice, de: Doppelt}, formula: ease * 2}
"""
# Karas (2020), table 7.2: the expert's raw answers after the hand task at 0 ms.
EXPERT = dict(
    zip((f"q{n}" for n in range(1, 13)), (2, 1, 1, 5, 1, 7, 7, 2, 1, 6, 1, 3), strict=True)
)


def score(lab: Lab, **fields: object) -> Json:
    """Return the scores of a form that is not stored."""
    result: Json = ok(lab.operator.post("/api/instruments/score", json=fields))
    return result


def test_the_library_lists_source_licence_and_use(lab: Lab) -> None:
    """The library lists every shipped instrument with its licence and the studies that use it."""
    library = {one["key"]: one for one in ok(lab.operator.get("/api/instruments"))}
    files = sorted((study_configs_dir() / "instruments").glob("*.yaml"))
    assert len(library) == len(files)
    assert library["karas2020"]["used_by"] == [STUDY]
    assert library["ssq"]["used_by"] == []
    assert library["ssq"]["items"] == 16
    assert all(one["provenance"]["licence"] for one in library.values())


@pytest.mark.one_engine
def test_an_instrument_has_a_preview_of_its_form(lab: Lab) -> None:
    """An instrument has a preview of its form, with items and formulas as tablets receive them."""
    detail = ok(lab.operator.get("/api/instruments/karas2020"))
    assert len(detail["preview"]["item_order"]) == 15
    assert detail["preview"]["item_order"][-1] == "problems"
    assert detail["preview"]["recode"] == "x - 4"
    assert len(detail["versions"]) == 1
    refusal = error(lab.operator.get("/api/instruments/nothing"), 404, "not_found")
    assert "ssq" in refusal["valid"]


@pytest.mark.one_engine
def test_a_check_returns_a_preview_or_the_problems(lab: Lab) -> None:
    """A check of an instrument returns a preview, or each problem with its path and line."""
    fine = ok(lab.operator.post("/api/instruments/check", json={"yaml": OWN}))
    assert (fine["ok"], fine["known"], fine["replaces"]) == (True, False, False)
    assert fine["preview"]["scores"][0]["formula"] == "(calm - tense) / 2"
    broken = OWN.replace("(calm - tense)", "(calm - tens)")
    bad = ok(lab.operator.post("/api/instruments/check", json={"yaml": broken}))
    (problem,) = bad["problems"]
    assert problem["path"] == "scores[0].formula"
    assert "tens" in broken.splitlines()[problem["line"] - 1]
    assert "tense" in problem["remedy"]
    assert bad["preview"] is None


@pytest.mark.one_engine
def test_the_experts_answers_score_as_printed(lab: Lab) -> None:
    """The expert's answers in Karas (2020), table 7.2, give the printed scores 8, 7, 4 and 1.04."""
    result = score(lab, key="karas2020", answers=EXPERT)
    values = {one["key"]: one["value"] for one in result["scores"]}
    assert (values["ownership"], values["agency"], values["location"]) == (8, 7, 4)
    assert values["soe_thesis"] == pytest.approx(1.0407, abs=5e-5)
    recoded = [one["recoded"] for one in result["items"]][:12]
    assert recoded == [-2, -3, -3, 1, -3, 3, 3, -2, -3, 2, -3, -1]
    ownership = next(one for one in result["scores"] if one["key"] == "ownership")
    assert ownership["filled_in"] == "((-2) - (-3)) - (-3) + (1 - (-3))"


@pytest.mark.one_engine
def test_a_score_without_value_names_the_missing_items(lab: Lab) -> None:
    """A score without a value names its missing items, also those that other scores need.

    An answer outside the scale is reported as a problem.
    """
    result = score(lab, yaml=OWN, answers={"calm": 5, "tense": 9, "note": "because"})
    ease, twice = result["scores"]
    assert (ease["value"], ease["missing"], ease["filled_in"]) == (None, ["tense"], "(2 - ?) / 2")
    assert (twice["value"], twice["missing"]) == (None, ["tense"])
    assert [one["item"] for one in result["problems"]] == ["tense"]
    request: Json = {"yaml": OWN, "answers": {"stranger": 1}}
    error(lab.operator.post("/api/instruments/score", json=request), 422, "invalid_input")
    request = {"answers": {}}
    error(lab.operator.post("/api/instruments/score", json=request), 422, "invalid_input")


def test_a_stored_study_keeps_its_instruments_wording(fresh_lab: Lab) -> None:
    """A stored study keeps its instruments' wording; its next version uses the newest wording."""
    shipped = ok(fresh_lab.operator.get("/api/instruments/karas2020"))
    changed = (
        shipped["yaml"]
        .replace("version: 1", "version: 2")
        .replace("I felt out of my body.", "I felt outside of my body.")
    )
    detail = ok(fresh_lab.operator.post("/api/instruments", json={"yaml": changed}))
    assert [one["used_by"] for one in detail["versions"]] == [[STUDY], []]
    assert (detail["version"], detail["used_by_older"]) == (2, [STUDY])
    view = fresh_lab.skip_to(fresh_lab.join(), "block1.hand.karas2020")
    form = ok(fresh_lab.operator.get(f"/api/sessions/{view['id']}/administration"))
    assert "I felt out of my body." in str(form["instrument"])
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    body = {"yaml": yaml.replace("Acting through", "Living through")}
    ok(fresh_lab.operator.post(f"/api/studies/{STUDY}/versions", json=body))
    diff = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}/diff?from=1&to=2"))
    assert [one["key"] for one in diff["instruments"]] == ["karas2020"]
    repeated = ok(fresh_lab.operator.post("/api/instruments", json={"yaml": changed}))
    assert repeated["stored_versions"] == 2


def test_a_number_stands_for_one_wording(fresh_lab: Lab) -> None:
    """Another wording under a number that is stored is refused at its line, also by the check."""
    shipped = ok(fresh_lab.operator.get("/api/instruments/ipq"))
    changed = shipped["yaml"].replace("virtual world", "virtual place", 1)
    assert changed != shipped["yaml"]
    refused = error(
        fresh_lab.operator.post("/api/instruments", json={"yaml": changed}), 422, "invalid_config"
    )
    (problem,) = refused["details"]
    assert (problem["path"], problem["value"]) == ("version", 1)
    assert changed.splitlines()[problem["line"] - 1] == "version: 1"
    assert problem["remedy"] == "Write version: 2."
    check = ok(fresh_lab.operator.post("/api/instruments/check", json={"yaml": changed}))
    assert (check["ok"], [one["path"] for one in check["problems"]]) == (False, ["version"])
    assert check["preview"] is not None
    body = {"yaml": changed.replace("version: 1", "version: 2", 1)}
    detail = ok(fresh_lab.operator.post("/api/instruments", json=body))
    assert [one["version"] for one in detail["versions"]] == [1, 2]
    again = ok(fresh_lab.operator.post("/api/instruments", json={"yaml": shipped["yaml"]}))
    assert again["stored_versions"] == 2
