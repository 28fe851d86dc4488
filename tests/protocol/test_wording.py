"""Tests of lines of a study's texts that apply to one kind of avatar only."""

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

FILES = [
    file
    for file in (
        CONFIGS / "reembodiment-latency.yaml",
        *sorted((CONFIGS / "templates").glob("*.yaml")),
    )
    if "boxes:" in file.read_text(encoding="utf-8")
]
"""The studies with boxes; those in which people only cross a road have none."""
HELD_BACK = re.compile(r"hold your virtual body|stop your virtual|halten Ihren virtuellen")
PASSES = re.compile(r"can pass through|hindurchgehen")


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_instructions_describe_the_boxes_for_the_avatar(file: Path) -> None:
    """Instructions state that boxes stop a physics avatar and let a delayed copy pass.

    This holds in both languages, in the file and in its stored form.
    """
    text = file.read_text(encoding="utf-8")
    for words, expected, unexpected in (
        (text, HELD_BACK, PASSES),
        (as_delayed_copy(text), PASSES, HELD_BACK),
    ):
        study = loaded(words)
        for protocol in (study.protocol, parse_study_json(study.canonical_json)):
            for wording in protocol.texts["instructions"].values():
                assert expected.search(wording)
                assert not unexpected.search(wording)
                assert "[avatar" not in wording
                assert "\n\n\n" not in wording


def test_both_variants_are_in_the_content() -> None:
    """Lines for both avatars are in the content, so the avatar can change without an edit."""
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
def test_an_invalid_avatar_mark_is_rejected(words: str, path: str, message: str) -> None:
    """A mark is rejected if its avatar is unknown, if it is within a line or if no text is left."""
    text = edited(("en: Please hold still for a few seconds.", f'en: "{words}"'))
    [problem] = problems(text)
    assert problem.path == path
    assert message in problem.message


def test_a_title_has_no_variants() -> None:
    """An avatar mark in a title is rejected, since marks are only read in texts."""
    title = "Acting through another body"
    [problem] = problems(edited((f"en: {title}", f'en: "[avatar: delayed_copy] {title}"')))
    assert problem.path == "title.en"


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_consent_names_the_time_that_the_visit_is_computed_to_take(file: Path) -> None:
    """The consent states the computed duration of the visit, to the nearest five minutes."""
    protocol = loaded(file.read_text(encoding="utf-8")).protocol
    minutes = visit_time(protocol, instruments()).total
    for language, words in (("en", r"about (\d+) minutes"), ("de", r"etwa (\d+) Minuten")):
        [stated] = re.findall(words, protocol.texts["consent"][language])
        assert abs(int(stated) - minutes) <= 2.5
