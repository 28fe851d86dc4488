"""The texts that pages take from the registries are the registries' own."""

import re

import pytest

from app.cli.page_texts import TARGET, page_texts, texts
from app.texts import Words, typescript_table
from tests.architecture.trees import REPOSITORY


def test_the_generated_file_is_what_the_registries_hold() -> None:
    """`python -m app.cli.page_texts` has been run since the last change of a registry."""
    assert (REPOSITORY / TARGET).read_text(encoding="utf-8") == page_texts()


def test_every_text_is_there_in_both_languages() -> None:
    """Keys are dotted, as in the tables that pages write themselves."""
    assert texts()["preflight.check.clock"] == Words(en="Clock", de="Uhr")
    assert all("." in key for key in texts())


@pytest.mark.parametrize(
    ("en", "de", "said"),
    [("", "Uhr", "empty in 'en'"), ("Clock", " ", "empty in 'de'"), ("{{a}}", "{{b}}", "['b']")],
)
def test_words_that_cannot_be_shown_are_refused(en: str, de: str, said: str) -> None:
    """A text that one language lacks, and placeholders that only one language fills in."""
    with pytest.raises(ValueError, match=re.escape(said)):
        Words(en=en, de=de)


def test_a_table_quotes_what_typescript_would_read_otherwise() -> None:
    """Quotes and line breaks are escaped; letters beyond ASCII stay as they are."""
    table = typescript_table("x", {"a.b": Words('say "no"', "ü\n")})
    assert '  "a.b": "say \\"no\\"",' in table
    assert '  "a.b": "ü\\n",' in table
    assert "export const xDe: Readonly<Record<keyof typeof xEn, string>> = {" in table
