"""Tests of study files over HTTP: problems with their position, and versions by content."""

from typing import Any

import pytest

from app.models import Study, StudyVersion
from tests.features.lab import STUDY, Json, Lab, error, ok

BOMB = "a0: &a0 [x, x]\n" + "\n".join(
    f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}, *a{n - 1}]" for n in range(1, 30)
)


@pytest.fixture(scope="module")
def yaml(lab: Lab) -> str:
    """Return the text of the shipped study's file as the interface returns it."""
    return str(ok(lab.operator.get(f"/api/studies/{STUDY}"))["yaml"])


def edit(yaml: str, *changes: tuple[str, str]) -> str:
    """Return a study file with some text replaced."""
    for old, new in changes:
        assert old in yaml
        yaml = yaml.replace(old, new, 1)
    return yaml


def rows(lab: Lab) -> tuple[int, int]:
    """Return how many studies and versions are stored."""
    with lab.database.reading() as db:
        return db.query(Study).count(), db.query(StudyVersion).count()


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("old", "new", "path"),
    [
        ("languages: [en, de]", "languages: [en, de]\nfavourite_colour: red", "favourite_colour"),
        ("latency_ms: 125", "latency_ms: -125", "conditions[1].latency_ms"),
        ("replicates: 2", "replicates: two", "orders.replicates"),
    ],
)
def test_a_problem_is_reported_with_its_position(
    lab: Lab, yaml: str, old: str, new: str, path: str
) -> None:
    """An unknown key, a negative latency or a wrong type is reported with path and position."""
    file = edit(yaml, (old, new))
    answer = lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": file})
    refusal = error(answer, 422, "invalid_config")
    (problem,) = refusal["details"]
    assert problem["path"].replace(".1.", "[1].") == path
    line = file.splitlines()[problem["line"] - 1]
    assert new.splitlines()[-1].split(":")[0] in line
    assert problem["column"] >= 1
    assert problem["message"]
    assert problem["remedy"]


@pytest.mark.one_engine
def test_all_problems_are_reported_together(lab: Lab, yaml: str) -> None:
    """All problems of a study file are reported in one answer."""
    file = edit(yaml, ("latency_ms: 125", "latency_ms: -1"), ("seed: 20200415", "seed: -1"))
    refusal = error(lab.operator.post("/api/studies", json={"yaml": file}), 422, "invalid_config")
    assert len(refusal["details"]) == 2


@pytest.mark.one_engine
@pytest.mark.parametrize("file", [BOMB, "[" * 1000, "a: !!python/object:os.system x", ""])
def test_a_hostile_file_is_refused_before_it_grows(lab: Lab, file: str) -> None:
    """A YAML file with expanding aliases, deep nesting or tags is refused while it is read."""
    before = rows(lab)
    answer = lab.operator.post("/api/studies", json={"yaml": file})
    assert error(answer, 422, "invalid_config")["details"][0]["line"] >= 1
    assert rows(lab) == before


@pytest.mark.one_engine
def test_a_study_file_with_a_nul_character_is_refused(lab: Lab) -> None:
    """A study file with a NUL character is refused and nothing is stored."""
    before = rows(lab)
    answer = lab.operator.post("/api/studies", json={"yaml": "key: a\x00b"})
    assert "NUL" in error(answer, 422, "invalid_input")["message"]
    assert rows(lab) == before


@pytest.mark.one_engine
def test_checking_stores_nothing(lab: Lab, yaml: str) -> None:
    """Checking a valid or invalid study file stores nothing."""
    before = rows(lab)
    check = "/api/studies/check"
    fine = ok(lab.operator.post(check, json={"yaml": edit(yaml, ("seed: 20200415", "seed: 3"))}))
    assert (fine["ok"], fine["key"], len(fine["content_hash"])) == (True, STUDY, 64)
    bad = ok(lab.operator.post(check, json={"yaml": "key: x"}))
    assert (bad["ok"], bool(bad["problems"])) == (False, True)
    assert rows(lab) == before


def test_the_same_content_is_the_same_version(fresh_lab: Lab) -> None:
    """A file that differs only in comments is the same version; other content is a new one."""
    study = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))
    same = _version(fresh_lab, "# a comment\n" + study["yaml"])
    assert same["versions"] == study["versions"]
    changed = _version(fresh_lab, edit(study["yaml"], ("Acting", "Playing")))
    assert [version["number"] for version in changed["versions"]] == [1, 2]
    assert changed["content_hash"] != study["content_hash"]


def test_a_version_is_frozen_from_its_first_start(fresh_lab: Lab) -> None:
    """A version is frozen when its first session starts, not when a session is created."""
    path = f"/api/studies/{STUDY}"
    view = fresh_lab.join()
    before = ok(fresh_lab.operator.get(path))
    assert not before["frozen"]
    fresh_lab.command(view, "start")
    frozen = ok(fresh_lab.operator.get(path))
    assert frozen["frozen"]
    _version(fresh_lab, edit(frozen["yaml"], ("Acting", "Playing")))
    versions = ok(fresh_lab.operator.get(path))["versions"]
    assert versions[0] == frozen["versions"][0]
    assert versions[1]["frozen_at"] is None


@pytest.mark.one_engine
def test_a_session_keeps_the_version_it_joined(fresh_lab: Lab) -> None:
    """A session keeps the study version with which it was created when a new one is stored."""
    view = fresh_lab.join()
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    _version(fresh_lab, edit(yaml, ("duration_s: 120", "duration_s: 30")))
    roam = [step for step in fresh_lab.view(view["id"])["steps"] if step["kind"] == "free_roam"]
    assert roam[0]["duration_s"] == 120
    assert fresh_lab.join()["study_version"] == 2


def test_a_study_is_created_once(fresh_lab: Lab) -> None:
    """Creating a second study with the same key is refused; under another key it is a new study."""
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    error(fresh_lab.operator.post("/api/studies", json={"yaml": yaml}), 409, "conflict")
    other = edit(yaml, (f"key: {STUDY}", "key: another"))
    assert ok(fresh_lab.operator.post("/api/studies", json={"yaml": other}))["key"] == "another"
    keys = [study["key"] for study in ok(fresh_lab.operator.get("/api/studies"))]
    assert keys == ["another", STUDY]


@pytest.mark.one_engine
def test_a_version_belongs_to_its_study(lab: Lab, yaml: str) -> None:
    """A version whose file has another study's key is refused, and both keys are reported."""
    file = edit(yaml, (f"key: {STUDY}", "key: stray"))
    answer = lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": file})
    refusal = error(answer, 409, "conflict")
    assert (refusal["value"], refusal["valid"]) == ("stray", STUDY)


@pytest.mark.one_engine
def test_an_unknown_study_is_not_found_and_the_existing_are_named(lab: Lab) -> None:
    """The error for an unknown study lists the keys of the existing studies."""
    refusal = error(lab.operator.get("/api/studies/nothing"), 404, "not_found")
    assert STUDY in refusal["valid"]


def _version(lab: Lab, yaml: str) -> Json:
    body: dict[str, Any] = {"yaml": yaml}
    study: Json = ok(lab.operator.post(f"/api/studies/{STUDY}/versions", json=body))
    return study


def test_a_version_that_began_before_another_is_refused_once(fresh_lab: Lab) -> None:
    """A text based on an older version is refused with the newest one, and stored on top of that.

    The same text again makes no further version, as after an answer that was lost.
    """
    place = f"/api/studies/{STUDY}/versions"
    text = str(ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"])
    first = edit(text, ("Acting through", "Living through"))
    second = edit(text, ("Acting through", "Being in"))
    assert ok(fresh_lab.operator.post(place, json={"yaml": first, "based_on": 1}))["version"] == 2
    late: Json = {"yaml": second, "based_on": 1}
    refused = error(fresh_lab.operator.post(place, json=late), 409, "stale")
    assert (refused["value"], refused["valid"]) == (1, 2)
    assert "version 2 was saved" in refused["message"]
    late["based_on"] = refused["valid"]
    assert ok(fresh_lab.operator.post(place, json=late))["version"] == 3
    unknown = {**late, "based_on": 9}
    assert error(fresh_lab.operator.post(place, json=unknown), 422, "invalid_input")["value"] == 9
    late["based_on"] = 2
    assert ok(fresh_lab.operator.post(place, json=late))["version"] == 3


@pytest.mark.one_engine
def test_a_study_is_named_in_each_of_its_languages_wherever_it_is_listed(lab: Lab) -> None:
    """Lists, the first page, a session and the storage have its title in every language."""
    view = lab.join()
    (study,) = (one for one in ok(lab.operator.get("/api/studies")) if one["key"] == STUDY)
    titles = study["titles"]
    assert set(titles) == {"en", "de"}
    assert (study["title"], study["description"]) == (titles["en"], study["descriptions"]["en"])
    today = ok(lab.operator.get("/api/lab", params={"since": "2020-01-01T00:00:00Z"}))["today"]
    room = ok(lab.operator.get("/api/storage"))
    (stored,) = (one["title"] for one in room["studies"] if one["key"] == STUDY)
    assert view["study_title"] == today[0]["study_title"] == stored == titles
