"""Tests that the sample of texts depends only on the commit and is drawn from all texts."""

from collections import Counter

from tests.architecture.trees import REPOSITORY
from tests.docs.draw_texts import SAMPLE, docstrings, drawn, page_texts


def test_a_seed_draws_the_same_texts_every_time() -> None:
    """The sample depends on the seed, contains no text twice, and changes with the seed."""
    texts = docstrings(REPOSITORY)
    first = drawn(texts, "0123abcd")
    assert first == drawn(texts, "0123abcd") != drawn(texts, "4567cdef")
    assert len({text.place + text.english for text in first}) == SAMPLE


def test_every_page_text_is_drawn_with_its_german() -> None:
    """Every text of the pages' tables is found with its German version."""
    texts = page_texts(REPOSITORY)
    assert len(texts) > 1000
    assert [text.place for text in texts if not text.german] == []


def test_no_key_has_two_texts() -> None:
    """A key is defined in one table of its pages, so that no table overrides another's text."""
    keys = Counter(
        (text.place.split("/")[2], text.place.rsplit(" ", 1)[1]) for text in page_texts(REPOSITORY)
    )
    assert [key for key, count in keys.items() if count > 1] == []
