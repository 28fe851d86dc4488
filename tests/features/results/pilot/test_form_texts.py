"""Tests that a pilot's texts for forms are true of what was simulated, in both languages."""

from dataclasses import replace

import pytest

from app.features.results.pilot.schemas import PhaseFigures, without_task
from app.features.results.pilot.simulation.check import Reached
from app.features.results.pilot.simulation.form_texts import Rehearsed, ethics_texts, rounded
from app.texts import LANGUAGES

REACHED = Reached("hand", "left", "tall", 1.869, 200.0, (), 3.0)
AS_PLANNED = Rehearsed(
    title={"en": "Two latencies", "de": "Zwei Verzögerungen"},
    people=12,
    seed=1,
    failures=0,
    used="physics",
    own="physics",
    session_min=13.7,
    planned_min=4.0,
    walk_back_min=1.26,
    storage_mb=6.2,
    reached=[REACHED],
)


def test_the_study_is_named_by_its_title_in_each_language() -> None:
    """The text has the title of its own language, and numbers as that language writes them."""
    texts = ethics_texts(AS_PLANNED)
    assert set(texts) == set(LANGUAGES)
    assert "the study “Two latencies” takes about 14 minutes, of which 1.3 minutes" in texts["en"]
    assert "„Zwei Verzögerungen“ dauert etwa 14 Minuten, davon 1,3 Minuten" in texts["de"]
    assert "{{" not in "".join(texts.values())


@pytest.mark.parametrize("walk_back_min", [0.0, 0.04])
def test_walks_back_are_named_only_if_there_are_any(walk_back_min: float) -> None:
    """Walks back that round to nothing are left out."""
    texts = ethics_texts(replace(AS_PLANNED, walk_back_min=walk_back_min))
    assert "walks back" not in texts["en"]
    assert "Rückwege" not in texts["de"]


def test_another_avatar_than_the_studys_own_is_named() -> None:
    """The text says through what people acted, if it was not the study's own avatar."""
    assert "avatar" not in ethics_texts(AS_PLANNED)["en"]
    texts = ethics_texts(replace(AS_PLANNED, used="delayed_copy"))
    assert "another avatar (a delayed copy of the body, which passes" in texts["en"]
    assert "than the study's own (physics with contacts)" in texts["en"]
    assert "einem anderen Avatar (verzögerte Kopie des Körpers" in texts["de"]


def test_visits_that_failed_are_counted() -> None:
    """The text counts visits that ended early, and otherwise says that all came to their end."""
    assert "all of these visits came to their end" in ethics_texts(AS_PLANNED)["en"]
    texts = ethics_texts(replace(AS_PLANNED, failures=1))
    assert "1 of these visits could not be completed" in texts["en"]
    assert "Termine, die nicht zu Ende kamen: 1." in texts["de"]


def _phase(limb: str, latency_ms: float, people: int, at_floor: float) -> PhaseFigures:
    means = dict.fromkeys(("completions", "completions_sd", "side_contacts", "contact_time_s"), 1.0)
    return PhaseFigures(
        limb=limb,
        latency_ms=latency_ms,
        people=people,
        out_of_order=0.0,
        walk_back_s=0.0,
        at_floor=at_floor,
        share_of_lowest=1.0,
        **means,
    )


def test_who_completes_nothing_is_counted_where_it_happens() -> None:
    """Three of four without a task are a finding; one of twelve is named only."""
    found = without_task(
        [
            _phase("hand", 0.0, 12, 0.0),
            _phase("hand", 125.0, 12, 1 / 12),
            _phase("hand", 350.0, 4, 0.75),
        ]
    )
    assert [(one.latency_ms, one.without, one.people, one.is_many) for one in found] == [
        (350.0, 3, 4, True),
        (125.0, 1, 12, False),
    ]


def test_visits_that_ended_are_not_called_done_tasks() -> None:
    """The ethics text says how many completed no task, or that everybody completed one."""
    idle = without_task([_phase("hand", 350.0, 4, 0.75)])
    said = ethics_texts(replace(AS_PLANNED, without_task=idle))
    assert "completed no task in a phase: 3 of 4 (hand task, 350 ms)." in said["en"]
    assert "keine Aufgabe geschafft: 3 von 4 (Handaufgabe, 350 ms)." in said["de"]
    all_did = ethics_texts(replace(AS_PLANNED, without_task=()))
    assert "Everybody completed at least one task in every phase." in all_did["en"]


def test_reach_is_said_with_what_the_check_leaves_out() -> None:
    """Both texts say that edges of boxes stopped nobody when reach was checked."""
    said = ethics_texts(AS_PLANNED)
    assert "edges of boxes stop nobody" in said["en"]
    assert "Kanten der Kästen niemanden aufhalten" in said["de"]


def test_the_length_of_a_visit_says_what_it_consists_of() -> None:
    """What the protocol sets, what is simulated and what is estimated are told apart."""
    said = ethics_texts(AS_PLANNED)
    assert "1.3 minutes are simulated walks back between tasks; 4 minutes are set" in said["en"]
    assert "Breaks and putting on the equipment are not included" in said["en"]
    assert "4 Minuten gibt das Studienprotokoll vor, der Rest ist" in said["de"]


def test_halves_are_rounded_as_on_the_page() -> None:
    """A half is rounded away from zero, and what rounds to zero has no sign."""
    assert [rounded(value, 1) for value in (10.25, 77.25, -0.25, 0.75)] == [
        "10.3",
        "77.3",
        "-0.3",
        "0.8",
    ]
    assert (rounded(-0.001, 2), rounded(12.5, 0)) == ("0.00", "13")
