"""Tests of practice, stop rules and signed consent in a study file."""

import json

import pytest

from app.protocol import compile_plan
from tests.protocol.helpers import BEFORE_RULES, loaded, problems
from tests.protocol.options import with_options

ORDER = ("latency_0", "latency_125", "latency_350")
PROTOCOL = loaded(with_options()).protocol
RULE = "score: sickness_score, stop_at: 15, warn_at: 10"
SHIPPED = "b62b8ecfa6a59a5feb957632fbfa65517f9d9542630c98bad2c496b2d90255a8"


def test_the_hash_of_a_study_without_options_stays() -> None:
    """Options that a study does not use do not change its hash."""
    study = loaded(BEFORE_RULES)
    assert study.content_hash == SHIPPED
    for word in ("safety", "signature", "statements", "practice", "optional"):
        assert word not in json.loads(study.canonical_json)["procedure"]["before"][0]
    assert "safety" not in json.loads(study.canonical_json)


def test_a_written_default_does_not_change_the_hash() -> None:
    """Writing the default signature `none` does not change the hash."""
    plain = "{step: consent, text: consent}"
    explicit = "{step: consent, text: consent, signature: none, statements: []}"
    assert loaded(BEFORE_RULES.replace(plain, explicit)).content_hash == SHIPPED


def test_a_practice_is_outside_the_blocks() -> None:
    """A practice has boxes, times and a latency, but neither block nor condition."""
    plan = compile_plan(PROTOCOL, ORDER)
    step = next(step for step in plan if step.kind == "practice")
    assert (step.key, step.limb, step.latency_ms) == ("practice.hand", "hand", 0)
    assert (step.preparation_s, step.duration_s, step.freeze_s) == (1, 30, 1)
    assert (step.block, step.condition, step.instrument) == (None, None, None)
    assert step.until_completions == 2
    assert step.title == {"en": "Practice with the hand", "de": "Übung mit der Hand"}
    assert [one.until_completions for one in plan if one.kind == "task"] == [None] * 6


def test_the_design_is_that_of_the_study_without_options() -> None:
    """Practice, signature and stop rules do not change the design hash."""
    assert PROTOCOL.design_hash == loaded().protocol.design_hash


@pytest.mark.parametrize(
    ("old", "new", "path", "expected_message"),
    [
        (RULE, "score: fms, stop_at: 15", "safety.stop_rules[0].score", "no score 'fms'"),
        (RULE, RULE.replace("15", "21"), "safety.stop_rules[0].stop_at", "by nobody"),
        (RULE, RULE.replace("10", "0"), "safety.stop_rules[0].warn_at", "by everybody"),
        (RULE, RULE.replace("10", "15"), "safety.stop_rules[0].warn_at", "not below"),
        (RULE, f"{RULE}, change_from: form.fms", "safety.stop_rules[0].change_from", "no form"),
        (RULE, f"{RULE}, change_from: fms", "safety.stop_rules[0].change_from", "no form"),
        ("{instrument: fms", "{instrument: ssq", "safety.stop_rules[0].instrument", "not ask"),
        ("limb: hand\n      prep", "limb: head\n      prep", "procedure.before[5].limb", "not v"),
        ("completions: 2", "completions: 0", "procedure.before[5].repeat_until", "range"),
        ("    - {step: materialise, text: t_pose}\n", "", "procedure.before[4].step", "a body"),
        ("signature: drawn", "signature: stamp", "procedure.before[0].signature", "'stamp'"),
        (
            "text: {en: I agree to take part., de: Ich nehme freiwillig teil.}",
            "text: {en: I agree to take part.}",
            "procedure.before[0].statements[1].text.de",
            "declared language",
        ),
    ],
)
def test_impossible_options_are_rejected_at_their_place(
    old: str, new: str, path: str, expected_message: str
) -> None:
    """Impossible stop rules, practices and signatures give problems with path and remedy."""
    found = [one for one in problems(with_options((old, new))) if one.path.startswith(path)]
    assert found
    assert expected_message in found[0].message
    assert found[0].remedy


def test_a_stop_rule_on_a_form_after_the_blocks_is_rejected() -> None:
    """A stop rule on a form that is only asked after the blocks is rejected."""
    late = with_options(
        ("    after: [{step: form, instrument: fms}]\n", ""),
        ("    - {step: debrief", "    - {step: form, instrument: fms}\n    - {step: debrief"),
    )
    found = [one for one in problems(late) if one.path == "safety.stop_rules[0].instrument"]
    assert "only after the blocks" in found[0].message


def test_a_stop_rule_may_use_the_change_of_a_score() -> None:
    """A stop rule may use the change since a form before the blocks, named by its key."""
    text = with_options(
        ("    - {step: height", "    - {step: form, instrument: fms}\n    - {step: height"),
        (RULE, "score: sickness_score, stop_at: 8, change_from: form.fms"),
    )
    safety = loaded(text).protocol.safety
    assert safety is not None
    assert safety.stop_rules[0].change_from == "form.fms"
