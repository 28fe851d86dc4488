"""Tests that a pilot's texts for forms are true of what was simulated, in both languages."""

from dataclasses import replace

import pytest

from app.features.results.pilot.simulation.check import Reached
from app.features.results.pilot.simulation.form_texts import Rehearsed, ethics_texts
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
    """The text counts what could not be completed, and otherwise says that all were."""
    assert "all of these visits could be completed" in ethics_texts(AS_PLANNED)["en"]
    texts = ethics_texts(replace(AS_PLANNED, failures=1))
    assert "1 of these visits could not be completed" in texts["en"]
    assert "Termine, die nicht zu Ende kamen: 1." in texts["de"]
