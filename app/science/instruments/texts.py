"""Whether every text is there in every language that is promised to participants."""

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from app.science.instruments.errors import DefinitionProblem

if TYPE_CHECKING:
    from app.science.instruments.model import Instrument, Scale, Text

_Path = tuple[str | int, ...]


def text_problems(
    path: _Path, text: Mapping[str, str], languages: Iterable[str]
) -> Iterator[DefinitionProblem]:
    """One problem for each declared language in which the text at `path` is missing or blank.

    A language that is not declared may be there: it is simply not offered.
    """
    for language in languages:
        if not text.get(language, "").strip():
            yield DefinitionProblem(
                (*path, language),
                f"The text has no wording in the declared language {language!r}.",
                sorted(text),
                f"a wording for {language}",
                f"Add it, or take {language} out of the languages.",
            )


def texts_of(instrument: "Instrument") -> "Iterator[tuple[_Path, Text]]":
    """Every text of an instrument with its path."""
    yield ("title",), instrument.title
    for field, text in (("stem", instrument.stem), ("instructions", instrument.instructions)):
        if text is not None:
            yield (field,), text
    for at, item in enumerate(instrument.items):
        yield ("items", at, "text"), item.text
        for number, choice in enumerate(item.choices):
            yield ("items", at, "choices", number, "label"), choice.label
        yield from _labels(item.scale, ("items", at, "scale"))
    yield from _labels(instrument.scale, ("scale",))
    for at, score in enumerate(instrument.scores):
        yield ("scores", at, "label"), score.label


def _labels(scale: "Scale | None", path: _Path) -> "Iterator[tuple[_Path, Text]]":
    for at, label in enumerate(() if scale is None else scale.labels):
        yield (*path, "labels", at), label
