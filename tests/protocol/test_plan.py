"""Tests of the steps of a session of the shipped study and its variants."""

import pytest

from app.protocol import PlanError, compile_plan
from app.science.tasks import Limb
from tests.protocol.helpers import edited, loaded, problems, study

STUDY = study()
ORDER = ("latency_350", "latency_0", "latency_125")


def test_each_block_is_hand_questionnaire_foot_questionnaire() -> None:
    """Each block is hand task, questionnaire, foot task, questionnaire (Karas 2020, 7.1.3)."""
    steps = [step for step in compile_plan(STUDY, ORDER) if step.block is not None]
    assert [(step.kind, step.limb) for step in steps] == [
        ("task", Limb.HAND),
        ("questionnaire", Limb.HAND),
        ("task", Limb.FOOT),
        ("questionnaire", Limb.FOOT),
    ] * 3
    assert [step.latency_ms for step in steps] == [350.0] * 4 + [0.0] * 4 + [125.0] * 4
    assert [step.block for step in steps] == [1] * 4 + [2] * 4 + [3] * 4


def test_the_session_around_the_blocks() -> None:
    """Before the blocks come consent, demographics, instructions, height, T-pose and free movement.

    The debriefing comes last.
    """
    steps = compile_plan(STUDY, ORDER)
    assert [step.key for step in steps if step.block is None] == [
        "consent",
        "form.demographics",
        "instructions",
        "height",
        "materialise",
        "free_roam",
        "debrief",
    ]
    roam = steps[5]
    assert (roam.duration_s, roam.latency_ms, roam.text) == (120, 0, "free_roam")


def test_tasks_carry_their_times_and_questionnaires_their_instrument() -> None:
    """Tasks have 60 s of active time, 5 s before and after; questionnaires, an instrument."""
    steps = {step.key: step for step in compile_plan(STUDY, ORDER)}
    task = steps["block2.hand"]
    assert (task.preparation_s, task.duration_s, task.freeze_s) == (5, 60, 5)
    assert (task.condition, task.text, task.instrument) == ("latency_0", "hand_task", None)
    questionnaire = steps["block2.hand.karas2020"]
    assert (questionnaire.instrument, questionnaire.condition, questionnaire.duration_s) == (
        "karas2020",
        "latency_0",
        None,
    )
    assert questionnaire.title["de"] == "Fragebogen"


def test_indices_count_and_keys_are_unique() -> None:
    """Steps are numbered consecutively and have unique keys."""
    twice = study(("- {step: height, text: height}", "- {step: consent, text: consent}"))
    for protocol in (STUDY, twice):
        steps = compile_plan(protocol, ORDER)
        assert [step.index for step in steps] == list(range(len(steps)))
        assert len({step.key for step in steps}) == len(steps)
    assert compile_plan(twice, ORDER)[3].key == "consent.2"


@pytest.mark.parametrize(
    ("flip", "first_limbs"), [(False, ["hand", "foot", "hand"]), (True, ["foot", "hand", "foot"])]
)
def test_alternating_limbs_turn_round_in_every_other_block(
    *, flip: bool, first_limbs: list[str]
) -> None:
    """With alternating limbs every second block starts with the other limb; a flip swaps them."""
    protocol = study(("limb_order: fixed", "limb_order: alternate"))
    tasks = [s for s in compile_plan(protocol, ORDER, block_limb_flip=flip) if s.kind == "task"]
    assert [step.limb for step in tasks[::2]] == first_limbs
    assert [step.limb for step in tasks[1::2]] != first_limbs


def test_fixed_limbs_never_turn_round() -> None:
    """With fixed limbs the flip has no effect."""
    assert compile_plan(STUDY, ORDER, block_limb_flip=True) == compile_plan(STUDY, ORDER)


def test_a_step_can_have_its_own_title() -> None:
    """A step's title in the study replaces the built-in one."""
    named = study(("limb: hand\n", "limb: hand\n        title: {en: Boxes, de: Kästen}\n"))
    steps = {step.key: step for step in compile_plan(named, ORDER)}
    assert steps["block1.hand"].title == {"en": "Boxes", "de": "Kästen"}


@pytest.mark.parametrize(
    "order", [(), ORDER[:2], (*ORDER, "latency_0"), ("latency_0", "latency_0", "latency_125")]
)
def test_an_order_names_each_condition_once(order: tuple[str, ...]) -> None:
    """An order that does not name each condition once is rejected."""
    with pytest.raises(PlanError, match="exactly once"):
        compile_plan(STUDY, order)


SICKNESS = (
    "        text: foot_task\n  after:",
    "        text: foot_task\n    after:\n      - {step: form, instrument: fms}\n  after:",
)


def test_a_block_can_end_with_forms_of_its_own() -> None:
    """A form at the end of a block has the block's condition and no limb."""
    protocol = study(SICKNESS)
    steps = [step for step in compile_plan(protocol, ORDER) if step.instrument == "fms"]
    assert [step.key for step in steps] == ["block1.fms", "block2.fms", "block3.fms"]
    assert [(step.kind, step.condition, step.limb) for step in steps] == [
        ("form", key, None) for key in ORDER
    ]
    assert protocol.instrument_keys == ("demographics", "karas2020", "fms")


def test_the_hash_of_a_study_without_forms_after_blocks_stays() -> None:
    """An empty list of forms after blocks is not part of the content."""
    assert '"after":[]' not in loaded().canonical_json


def test_an_unknown_instrument_at_the_end_of_a_block_names_its_path() -> None:
    """An unknown instrument at the end of a block raises an error that names its path."""
    old, new = SICKNESS
    (problem,) = problems(edited((old, new.replace("fms", "fmz"))))
    assert problem.path == "procedure.block.after[0].instrument"
