"""Tests of the rules that decide whether a completed session is valid."""

import json
from pathlib import Path

import pytest
import yaml

from tests.protocol.helpers import BEFORE_RULES, CONFIGS, STUDY, edited, loaded, problems, study

HAND = "{phase: hand, min_active_share: 0.9}"


def test_the_shipped_study_asks_for_its_tasks_and_its_questionnaire() -> None:
    """The shipped study requires nine tenths of each task's minute and every karas2020 form."""
    rules = study().valid_when
    assert rules is not None
    assert [(one.phase, one.least_s(60.0)) for one in rules.phases] == [("hand", 54), ("foot", 54)]
    assert rules.forms == ("karas2020",)
    assert rules.achieved_latency is None


@pytest.mark.parametrize(
    "file", sorted((CONFIGS / "templates").glob("*.yaml")), ids=lambda f: f.stem
)
def test_a_template_asks_for_every_task_and_every_form_of_a_block(file: Path) -> None:
    """A template's rules require all tasks and all questionnaires of its blocks."""
    protocol = loaded(file.read_text(encoding="utf-8")).protocol
    rules, block = protocol.valid_when, protocol.procedure.block
    assert rules is not None
    crossing = [] if block.crossing is None else [block.crossing]
    done = {str(one.limb) for one in block.phases} | {one.kind for one in crossing}
    assert {one.phase for one in rules.phases} == done
    requested = {
        *(one.questionnaire for one in crossing),
        *(one.questionnaire for one in block.phases),
        *(one.instrument for one in block.after),
    }
    assert requested <= set(rules.forms)


def test_an_older_study_keeps_its_content() -> None:
    """A study without the key has no rules in its content, and an obsolete setting still loads."""
    older = loaded(BEFORE_RULES)
    assert older.protocol.valid_when is None
    content = json.loads(older.canonical_json)
    assert "valid_when" not in content
    assert content["latency"] == {"undelayed_parts": ["Hips"], "bypass_at_zero": True}
    assert "bypass_at_zero" not in json.loads(loaded().canonical_json)["latency"]


def test_unknown_phases_and_forms_are_rejected_with_the_valid_ones() -> None:
    """An unknown phase or form raises an error with its path, the value and the valid keys."""
    [phase] = problems(edited((HAND, "{phase: hands}")))
    assert (phase.path, phase.value) == ("valid_when.phases[0].phase", "hands")
    assert phase.valid == ["free_roam", "hand", "foot"]
    [form] = problems(edited(("forms: [karas2020]", "forms: [karas2020, veq]")))
    assert (form.path, form.value) == ("valid_when.forms[1]", "veq")
    assert form.valid == ["demographics", "karas2020"]


def test_unsatisfiable_rules_are_rejected() -> None:
    """A rule that requires more active time than a phase has is rejected."""
    [problem] = problems(edited((HAND, "{phase: hand, min_active_s: 61}")))
    assert (problem.path, problem.value) == ("valid_when.phases[0].min_active_s", 61)
    assert problem.valid == "above 0, at most 60"


@pytest.mark.parametrize(
    ("rules", "path"),
    [
        ({}, "valid_when"),
        (
            {"phases": [{"phase": "hand", "min_active_s": 9, "min_active_share": 0.5}]},
            "valid_when.phases[0].min_active_share",
        ),
        ({"phases": [{"phase": "hand"}, {"phase": "hand"}]}, "valid_when.phases[1]"),
        ({"forms": ["karas2020", "karas2020"]}, "valid_when.forms[1]"),
        (
            {"forms": ["karas2020"], "achieved_latency": {"reported": True}},
            "valid_when.achieved_latency",
        ),
    ],
)
def test_empty_and_duplicate_rules_are_rejected(rules: dict[str, object], path: str) -> None:
    """Empty rules, duplicate keys and a latency rule without a phase are rejected."""
    tree = yaml.safe_load(STUDY)
    tree["valid_when"] = rules
    [problem] = problems(yaml.safe_dump(tree, allow_unicode=True))
    assert problem.path == path
    assert problem.remedy
