"""Tests of the shipped latency study against the thesis and against its own texts."""

import pytest

from app.science.tasks import Side, SurfaceKind
from tests.protocol.helpers import SHIPPED, instruments, loaded, study

STUDY = loaded(SHIPPED).protocol


def test_conditions_and_orders_are_those_of_the_thesis() -> None:
    """Conditions are 0, 125 and 350 ms, in all 3! orders twice (Karas 2020, 7.1.3)."""
    assert [one.latency_ms for one in STUDY.conditions] == [0, 125, 350]
    assert (STUDY.orders.design, STUDY.orders.replicates) == ("all_permutations", 2)
    assert STUDY.latency.undelayed_parts == ("Hips",)
    assert STUDY.instrument_keys == ("demographics", "karas2020")
    assert STUDY.condition("latency_125").latency_ms == 125


def test_hand_boxes_stand_in_a_row_with_four_walls_each() -> None:
    """The hand task has four boxes with a panel and four sides, and one target.

    The order of the boxes is reversed after each completed task.
    """
    layout = STUDY.tasks.layout("hand")
    assert layout.n_boxes == 4
    assert layout.reverse_after_task
    sides = [one.side for one in layout.surfaces if one.kind is SurfaceKind.SIDE and one.box == 1]
    assert sorted(sides, key=str) == [Side.BOTTOM, Side.LEFT, Side.RIGHT, Side.TOP]
    for surface in layout.surfaces:
        assert 1.0 < surface.center_m[1] < 1.5
        assert -0.7 < surface.center_m[2] < -0.4


def test_foot_boxes_are_a_tenth_longer_than_their_base_length() -> None:
    """The shipped study's foot boxes are 10 % longer, and either foot counts (Karas 2020, 7.2)."""
    foot = STUDY.tasks.foot
    assert foot is not None
    assert foot.length_m == pytest.approx(0.396, abs=1e-12)
    layout = foot.layout()
    panel = layout.by_key["foot/1/panel"]
    assert 2 * panel.half_size_m[2] == pytest.approx(0.396, abs=1e-12)
    assert layout.start_key == "foot/start"
    assert layout.counting_foot is None
    assert not layout.reverse_after_task


def test_a_single_foot_can_be_made_to_count() -> None:
    """The study can be configured to count one foot only."""
    left = study(("counting_foot: either", "counting_foot: left"))
    assert left.tasks.layout("foot").counting_foot == "left"


def test_participants_are_not_told_the_condition() -> None:
    """No text before the debriefing mentions latency to the participant."""
    for key, text in STUDY.texts.items():
        for words in text.values():
            mentions = [
                secret for secret in ("latenc", "delay", "erzöger", "125", "350") if secret in words
            ]
            assert bool(mentions) == (key == "debrief"), (key, mentions)


def test_the_instructions_say_what_matters() -> None:
    """The instructions mention solid boxes, leaning, the resting hand, sickness and the freeze."""
    english = STUDY.texts["instructions"]["en"]
    for word in ("solid", "lean", "step to the side", "rest", "sick", "freezes", "mirror", "white"):
        assert word in english
    assert english.rstrip().endswith("Please ask now.")
    assert STUDY.texts["instructions"]["de"].rstrip().endswith("Bitte fragen Sie jetzt.")


def test_a_second_palette_uses_shapes() -> None:
    """For people who confuse red and green there are other colours, and a shape for every state."""
    standard, safe = STUDY.appearance.palettes
    assert STUDY.appearance.default == standard.key
    assert safe.colours.panel_done != standard.colours.panel_done
    cues = safe.cues.model_dump()
    assert "none" not in cues.values()
    assert len(set(cues.values())) == len(cues)


def test_every_instrument_can_be_scored_and_asked() -> None:
    """Every shipped instrument is consistent and has both languages."""
    for instrument in instruments().values():
        assert instrument.languages == STUDY.languages
        assert instrument.provenance.licence
