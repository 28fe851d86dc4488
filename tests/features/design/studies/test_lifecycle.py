"""Tests of comparing versions, and of duplicating, archiving and restoring studies."""

import pytest

from tests.features.design.studies.test_studies import edit
from tests.features.lab import STUDY, Json, Lab, error, ok

PATH = f"/api/studies/{STUDY}"


def yaml_of(lab: Lab) -> str:
    """Return the file of the study's newest version."""
    return str(ok(lab.operator.get(PATH))["yaml"])


def add(lab: Lab, *changes: tuple[str, str]) -> None:
    """Store a new version of the study with some text replaced."""
    body = {"yaml": edit(yaml_of(lab), *changes)}
    ok(lab.operator.post(f"{PATH}/versions", json=body))


def diff(lab: Lab, source: int, target: int) -> Json:
    """Return the differences between two versions of the study."""
    answer = lab.operator.get(f"{PATH}/diff", params={"from": source, "to": target})
    found: Json = ok(answer)
    return found


@pytest.mark.one_engine
def test_a_diff_says_whether_balance_is_affected(fresh_lab: Lab) -> None:
    """A diff reports that another latency needs a new ledger, and that other wording does not."""
    add(fresh_lab, ("Acting through", "Living through"))
    add(fresh_lab, ("latency_ms: 125", "latency_ms: 200"))
    words, latency = diff(fresh_lab, 1, 2), diff(fresh_lab, 2, 3)
    assert [change["path"] for change in words["changes"]] == ["title.en"]
    assert not words["new_ledger"]
    (change,) = latency["changes"]
    assert change["path"] == "conditions[1].latency_ms"
    assert (change["before"], change["after"]) == (125, 200)
    assert latency["new_ledger"]
    assert "-    latency_ms: 125\n+    latency_ms: 200" in latency["text"]
    assert diff(fresh_lab, 1, 1)["same"]
    error(fresh_lab.operator.get(f"{PATH}/diff?from=1&to=9"), 404, "not_found")


@pytest.mark.one_engine
def test_a_draft_is_compared_with_the_newest_version(fresh_lab: Lab) -> None:
    """A draft is compared with the newest version; sessions that keep their version are counted."""
    fresh_lab.join()
    same = ok(fresh_lab.operator.post(f"{PATH}/diff", json={"yaml": "# x\n" + yaml_of(fresh_lab)}))
    assert (same["same"], same["changes"], same["target"]) == (True, [], None)
    assert same["under_way"] == 1
    body = {"yaml": edit(yaml_of(fresh_lab), ("seed: 20200415", "seed: 4"))}
    assert ok(fresh_lab.operator.post(f"{PATH}/diff", json=body))["new_ledger"]


def test_every_version_can_be_read(fresh_lab: Lab) -> None:
    """An earlier version can be read, with the wordings of its instruments."""
    first = yaml_of(fresh_lab)
    add(fresh_lab, ("Acting through", "Living through"))
    version = ok(fresh_lab.operator.get(f"{PATH}/versions/1"))
    assert version["yaml"] == first
    assert set(version["instruments"]) == {"demographics", "karas2020"}
    error(fresh_lab.operator.get(f"{PATH}/versions/3"), 404, "not_found")


def test_a_duplicate_is_an_independent_study(fresh_lab: Lab) -> None:
    """A duplicated study has its own key and title and the same comments."""
    request = {"key": "second", "title": {"en": "A second study"}}
    copy = ok(fresh_lab.operator.post(f"{PATH}/duplicate", json=request))
    assert (copy["key"], copy["title"], copy["version"]) == ("second", "A second study", 1)
    kept = [line for line in yaml_of(fresh_lab).splitlines() if line.startswith("#")]
    assert [line for line in kept if line not in copy["yaml"]] == []
    assert ok(fresh_lab.operator.get(PATH))["version"] == 1
    error(fresh_lab.operator.post(f"{PATH}/duplicate", json=request), 409, "conflict")
    request = {"key": "Not a key"}
    error(fresh_lab.operator.post(f"{PATH}/duplicate", json=request), 422, "invalid_config")


def test_an_archived_study_refuses_new_sessions(fresh_lab: Lab) -> None:
    """An archived study is not listed and refuses sessions; a restored one continues its ledger."""
    view = fresh_lab.command(fresh_lab.join(), "start")
    refusal = error(fresh_lab.operator.post(f"{PATH}/archive"), 409, "not_now")
    assert (refusal["value"], refusal["valid"]) == (1, 0)
    fresh_lab.command(view, "abort", reason="not in this test")
    assert ok(fresh_lab.operator.post(f"{PATH}/archive"))["archived_at"] is not None
    assert ok(fresh_lab.operator.get("/api/studies")) == []
    (listed,) = ok(fresh_lab.operator.get("/api/studies?archived=true"))
    assert listed["key"] == STUDY
    refusal = error(fresh_lab.try_join(), 409, "not_now")
    assert "Restore" in refusal["remedy"]
    assert ok(fresh_lab.operator.post(f"{PATH}/restore"))["archived_at"] is None
    assert fresh_lab.join()["slot"]["index"] == view["slot"]["index"]
