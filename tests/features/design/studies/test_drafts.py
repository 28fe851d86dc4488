"""Tests of editing a study over HTTP: templates, checks, form edits and dry runs."""

import pytest

from tests.features.design.studies.test_studies import edit
from tests.features.lab import STUDY, Json, Lab, error, ok


@pytest.fixture(scope="module")
def yaml(lab: Lab) -> str:
    """Return the text of the shipped study's file."""
    return str(ok(lab.operator.get(f"/api/studies/{STUDY}"))["yaml"])


@pytest.mark.one_engine
def test_templates_are_valid_and_are_not_stored_studies(lab: Lab) -> None:
    """Five templates are offered and pass the check; only the shipped study is stored."""
    templates = ok(lab.operator.get("/api/templates"))
    assert templates[0]["key"] == STUDY
    needing_feet = {one["key"] for one in templates if one["needs_feet"]}
    assert needing_feet == {STUDY, "four-latencies-williams"}
    assert len(templates) == 5
    for template in templates:
        assert set(template["title"]) == {"en", "de"}
        assert ok(lab.operator.post("/api/studies/check", json={"yaml": template["yaml"]}))["ok"]
    assert [one["key"] for one in ok(lab.operator.get("/api/studies"))] == [STUDY]


@pytest.mark.one_engine
def test_a_check_summarises_orders_slots_forms_and_duration(lab: Lab, yaml: str) -> None:
    """Checking the shipped study finds 3 conditions, 6 orders, 12 slots, 7 forms, 9 minutes."""
    summary = ok(lab.operator.post("/api/studies/check", json={"yaml": yaml}))["summary"]
    assert {key: summary[key] for key in ("conditions", "orders", "slots", "administrations")} == {
        "conditions": 3,
        "orders": 6,
        "slots": 12,
        "administrations": 7,
    }
    assert summary["planned_minutes"] == 9.0
    assert summary["minutes"] > summary["planned_minutes"]


@pytest.mark.one_engine
def test_the_duration_of_a_visit_is_the_same_everywhere(lab: Lab, yaml: str) -> None:
    """The study's overview, the editor and the dry run give the same duration of a visit."""
    study = ok(lab.operator.get(f"/api/studies/{STUDY}"))
    summary = ok(lab.operator.post("/api/studies/check", json={"yaml": yaml}))["summary"]
    run = ok(lab.operator.post("/api/studies/timeline", json={"yaml": yaml}))
    figures = {"minutes": run["total_s"] / 60, "planned_minutes": run["planned_s"] / 60}
    for name, minutes in figures.items():
        assert study[name] == summary[name] == pytest.approx(minutes, abs=0.05)


@pytest.mark.one_engine
def test_an_invalid_file_still_returns_its_values_and_lines(lab: Lab, yaml: str) -> None:
    """The check of an invalid study file still returns its values and their line numbers."""
    broken = edit(yaml, ("latency_ms: 125", "latency_ms: -125"))
    answer = ok(lab.operator.post("/api/studies/check", json={"yaml": broken}))
    assert not answer["ok"]
    assert answer["tree"]["conditions"][1]["latency_ms"] == -125
    line = answer["lines"]["conditions[1].latency_ms"]
    assert broken.splitlines()[line - 1].strip() == "latency_ms: -125"
    assert ok(lab.operator.post("/api/studies/check", json={"yaml": "a: ["}))["tree"] is None


@pytest.mark.one_engine
def test_an_edit_changes_only_its_own_line(lab: Lab, yaml: str) -> None:
    """An edit from the form changes only its own line; one that does not fit is refused."""
    path = ["conditions", 1, "latency_ms"]
    body = {"yaml": yaml, "changes": [{"path": path, "value": 200}]}
    after = ok(lab.operator.post("/api/studies/edit", json=body))["yaml"]
    changed = [
        pair for pair in zip(yaml.splitlines(), after.splitlines(), strict=True) if len({*pair}) > 1
    ]
    assert changed == [("    latency_ms: 125", "    latency_ms: 200")]
    body = {"yaml": yaml, "changes": [{"path": ["conditions", 7], "action": "remove"}]}
    refusal = error(lab.operator.post("/api/studies/edit", json=body), 422, "invalid_config")
    assert refusal["details"][0]["path"] == "conditions[7]"


def test_a_dry_run_of_slot_0_matches_the_first_session(fresh_lab: Lab) -> None:
    """A dry run of slot 0 has the order and steps of the first participant's session."""
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    dry: Json = ok(fresh_lab.operator.post("/api/studies/timeline", json={"yaml": yaml, "slot": 0}))
    session = fresh_lab.join()
    assert dry["latencies_ms"] == session["sequence"]
    assert [step["key"] for step in dry["steps"]] == [step["key"] for step in session["steps"]]
    assert dry["planned_s"] == 540
    assert dry["steps"][-1]["start_s"] + dry["steps"][-1]["length_s"] == dry["total_s"]


@pytest.mark.one_engine
def test_a_dry_run_of_any_slot_and_order(lab: Lab, yaml: str) -> None:
    """A dry run works for slots beyond the current ledger and for every order of the design."""

    def run(**fields: object) -> Json:
        body = {"yaml": yaml, **fields}
        view: Json = ok(lab.operator.post("/api/studies/timeline", json=body))
        return view

    assert run(slot=12)["replicate"] == 3
    assert {tuple(run(sequence_index=at)["sequence"]) for at in range(6)} == {
        tuple(run(slot=at)["sequence"]) for at in range(6)
    }
    assert run(slot=0, language="de")["steps"][0]["title"] == "Einwilligung"
    body = {"yaml": yaml, "sequence_index": 6}
    error(lab.operator.post("/api/studies/timeline", json=body), 422, "invalid_input")
    error(lab.operator.post("/api/studies/timeline", json={"yaml": "a: 1"}), 422, "invalid_config")
