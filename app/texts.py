"""Texts that people see, in both languages, defined next to what they describe.

A registry (such as `app/features/record/preflight/checks/registry.py`, or
`app/adapters/captures/formats.py`) contains objects with their own texts. Pages cannot import
Python, so their tables of texts are generated: `python -m app.cli.page_texts` writes them, and a
test fails while one is out of date.
"""

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

LANGUAGES = ("en", "de")
_PLACEHOLDER = re.compile(r"{{(\w+)}}")


@dataclass(frozen=True)
class Words:
    """One text in English and in German.

    `{{name}}` stands for a value that the page fills in; both languages must have the same
    placeholders. Raises ValueError if a text is empty or the placeholders differ.
    """

    en: str
    de: str

    def __post_init__(self) -> None:
        for language in LANGUAGES:
            if not self.in_language(language).strip():
                raise ValueError(
                    f"The text {self.en or self.de!r} is empty in {language!r}; write it in both "
                    f"languages: {', '.join(LANGUAGES)}."
                )
        of_en, of_de = (sorted(_PLACEHOLDER.findall(text)) for text in (self.en, self.de))
        if of_en != of_de:
            raise ValueError(
                f"The English text {self.en!r} has the placeholders {of_en}, the German one "
                f"{of_de}; use the same in both."
            )

    def in_language(self, language: str) -> str:
        """Return the text in "en" or "de"; raise KeyError for any other language."""
        return {"en": self.en, "de": self.de}[language]


def chosen(text: Mapping[str, str], language: str) -> str:
    """Return a study's text in a language; in the first one it has if that one is missing."""
    return text.get(language) or next(iter(text.values()), "")


def typescript_table(name: str, texts: Mapping[str, Words]) -> str:
    """Generate the TypeScript constants `nameEn` and `nameDe`, flat tables from key to text."""
    lines = []
    for language in LANGUAGES:
        constant = f"{name}{language.capitalize()}"
        typed = "" if language == "en" else f": Readonly<Record<keyof typeof {name}En, string>>"
        lines.append(f"export const {constant}{typed} = {{")
        lines += [
            f"  {json.dumps(key)}: {json.dumps(words.in_language(language), ensure_ascii=False)},"
            for key, words in texts.items()
        ]
        lines.append("} as const;" if language == "en" else "};")
    return "\n".join(lines) + "\n"


def typescript_object(name: str, values: Mapping[str, object]) -> str:
    """Generate the TypeScript constant `name`, an object of plain values with literal types."""
    items = [
        f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)},"
        for key, value in values.items()
    ]
    return "\n".join([f"export const {name} = {{", *items, "} as const;"]) + "\n"


def typescript_list(name: str, values: Iterable[str]) -> str:
    """Generate the TypeScript constant `name`, a tuple of texts with literal types."""
    items = [f"  {json.dumps(value, ensure_ascii=False)}," for value in values]
    return "\n".join([f"export const {name} = [", *items, "] as const;"]) + "\n"
