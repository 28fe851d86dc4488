"""Lines of texts that hold for one kind of avatar."""

import re
from pathlib import Path

import pytest

from app.protocol import parse_study_json, visit_time
from tests.protocol.helpers import (
    CONFIGS,
    SHIPPED,
    as_delayed_copy,
    edited,
    instruments,
    loaded,
    problems,
)

FILES = [CONFIGS / "reembodiment-latency.yaml", *sorted((CONFIGS / "templates").glob("*.yaml"))]
HELD_BACK = re.compile(r"hold your virtual body|stop your virtual|halten Ihren virtuellen")
PASSES = re.compile(r"can pass through|hindurchgehen")


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_what_the_boxes_do_is_told_as_it_is(file: Path) -> None:
    """They hold a simulated body back and let a copy through, in both languages, stored or not."""
    text = file.read_text(encoding="utf-8")
    for words, said, unsaid in (
        (text, HELD_BACK, PASSES),
        (as_delayed_copy(text), PASSES, HELD_BACK),
    ):
        study = loaded(words)
        for protocol in (study.protocol, parse_study_json(study.canonical_json)):
            for wording in protocol.texts["instructions"].values():
                assert said.search(wording)
                assert not unsaid.search(wording)
                assert "[avatar" not in wording
                assert "\n\n\n" not in wording


def test_both_variants_are_in_the_content() -> None:
    """So another avatar takes its own lines without an edit, and every line is hashed."""
    content = loaded(SHIPPED).canonical_json
    assert "[avatar: physics]" in content
    assert "[avatar: delayed_copy]" in content
    assert loaded(SHIPPED).protocol.avatar == "physics"


@pytest.mark.parametrize(
    ("words", "path", "message"),
    [
        ("[avatar: ghost] Hold still.", "texts.freeze.en", "names the avatar 'ghost'"),
        ("Hold [avatar: physics] still.", "texts.freeze.en", "where it has no effect"),
        ("[avatar: physics] Hold still.", "texts.freeze.en", "this text is empty"),
    ],
)
def test_a_mark_that_would_be_shown_or_leave_nothing_is_refused(
    words: str, path: str, message: str
) -> None:
    """Of no avatar, in the middle of a line, with nothing for the study's own avatar."""
    text = edited(("en: Please hold still for a few seconds.", f'en: "{words}"'))
    [problem] = problems(text)
    assert problem.path == path
    assert message in problem.message


def test_a_title_has_no_variants() -> None:
    """Marks are read in texts; elsewhere they would be shown."""
    title = "Acting through another body"
    [problem] = problems(edited((f"en: {title}", f'en: "[avatar: delayed_copy] {title}"')))
    assert problem.path == "title.en"


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_consent_names_the_time_that_the_visit_is_computed_to_take(file: Path) -> None:
    """The same figure as in overview and editor, to the nearest five minutes."""
    protocol = loaded(file.read_text(encoding="utf-8")).protocol
    minutes = visit_time(protocol, instruments()).total
    for language, words in (("en", r"about (\d+) minutes"), ("de", r"etwa (\d+) Minuten")):
        [told] = re.findall(words, protocol.texts["consent"][language])
        assert abs(int(told) - minutes) <= 2.5
