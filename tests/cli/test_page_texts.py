"""Tests that the pages' generated texts are those of the registries."""

import re

import pytest

from app.cli.page_texts import TARGET, page_texts, texts
from app.texts import Words, typescript_table
from tests.architecture.trees import REPOSITORY


def test_the_generated_file_is_up_to_date() -> None:
    """The generated file of page texts is up to date with the registries."""
    assert (REPOSITORY / TARGET).read_text(encoding="utf-8") == page_texts()


def test_every_text_is_there_in_both_languages() -> None:
    """Every page text has a dotted key and both languages."""
    assert texts()["preflight.check.clock"] == Words(en="Clock", de="Uhr")
    assert all("." in key for key in texts())


@pytest.mark.parametrize(
    ("en", "de", "message"),
    [("", "Uhr", "empty in 'en'"), ("Clock", " ", "empty in 'de'"), ("{{a}}", "{{b}}", "['b']")],
)
def test_words_lacking_a_language_or_placeholder_are_refused(
    en: str, de: str, message: str
) -> None:
    """Words that lack a language, or have a placeholder in only one, are refused."""
    with pytest.raises(ValueError, match=re.escape(message)):
        Words(en=en, de=de)


def test_a_typescript_table_escapes_quotes_and_line_breaks() -> None:
    """A TypeScript table escapes quotes and line breaks and keeps other letters."""
    table = typescript_table("x", {"a.b": Words('say "no"', "ü\n")})
    assert '  "a.b": "say \\"no\\"",' in table
    assert '  "a.b": "ü\\n",' in table
    assert "export const xDe: Readonly<Record<keyof typeof xEn, string>> = {" in table
