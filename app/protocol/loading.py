"""Load a file's text as a value with a content hash, reporting all problems of the file together.

The hash is computed from the *validated* content as canonical JSON, including defaults. So
comments, key order, quoting and 60 for 60.0 make no difference, and stored content stays complete
even if a later release changes a default.
"""

import copy
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Generic, TypeVar, cast

from pydantic import TypeAdapter, ValidationError

from app.plain_titles import LONGEST_TITLE, not_plain
from app.protocol.assumptions import Assumptions, assumption_problems
from app.protocol.common import canonical_json, sha256_of
from app.protocol.cross import ConfigurationOf, cross_problems
from app.protocol.errors import ConfigError, ConfigProblem
from app.protocol.explanations import UNKNOWN_KEY, explain, locate, remove
from app.protocol.schema import Schema
from app.protocol.source import Plain, Source, read_source
from app.protocol.study import StudyProtocol
from app.protocol.wording import with_avatar_lines
from app.science.instruments import DefinitionProblem, Instrument

_Value = TypeVar("_Value")


@dataclass(frozen=True)
class LoadedStudy:
    """A study with the SHA-256 of its content, which is computed from `canonical_json`.

    The texts of `protocol` are those for its avatar; the content also contains the lines for
    others.
    """

    protocol: StudyProtocol
    content_hash: str
    canonical_json: str


@dataclass(frozen=True)
class LoadedInstrument:
    """An instrument with the SHA-256 of its content."""

    instrument: Instrument
    content_hash: str
    canonical_json: str


@dataclass(frozen=True)
class LoadedAssumptions:
    """The assumptions of a simulation with the SHA-256 of their content."""

    assumptions: Assumptions
    content_hash: str


def load_study(
    text: str,
    *,
    instruments: Mapping[str, Instrument],
    avatars: Mapping[str, int] | None = None,
    bodies: Mapping[str, str] | None = None,
    configured: ConfigurationOf | None = None,
) -> LoadedStudy:
    """Load a study file (YAML).

    Args:
        text: the text of the file.
        instruments: those that it may refer to, by key.
        avatars: those that it may refer to: key -> number of the newest version. None skips the
            check.
        bodies: bodies that its conditions may refer to: name -> hash of the model. None skips the
            check.
        configured: returns the configuration of an avatar's key and version, to check changes to
            the avatar; None skips this.

    Raises:
        ConfigError: the file is invalid; the error lists every problem.
    """
    source = study_source(text)
    between = cross_problems(source.tree, _STUDY.schema, instruments, avatars, bodies, configured)
    found = [locate(one, source) for one in (*between, *_long_titles(source.tree))]
    protocol = _validated(_STUDY, source, found)
    canonical = canonical_json(_STUDY.adapter.dump_python(protocol, mode="json"))
    return LoadedStudy(with_avatar_lines(protocol), sha256_of(canonical), canonical)


@lru_cache(maxsize=16)
def study_source(text: str) -> Source:
    """Parse a study file, caching the result.

    The same file is parsed when it is checked, when it is saved and at every start.
    """
    return read_source(text)


@lru_cache(maxsize=64)
def load_instrument(text: str) -> LoadedInstrument:
    """Load an instrument file (YAML); raise ConfigError with every problem of the file.

    Results are cached by text: whenever a study is loaded, so are its instruments.
    """
    source = read_source(text)
    wrong = (*_titles_that_are_not_plain(source.tree), *_long_titles(source.tree))
    found = [locate(one, source) for one in wrong]
    instrument = _validated(_INSTRUMENT, source, found)
    canonical = canonical_json(instrument_as_json(instrument))
    return LoadedInstrument(instrument, sha256_of(canonical), canonical)


def load_assumptions(
    text: str, study: StudyProtocol, instruments: Mapping[str, Instrument]
) -> LoadedAssumptions:
    """Load what a simulation of a study assumes (YAML); raise ConfigError with every problem."""
    source = read_source(text)
    given = _validated(_ASSUMPTIONS, source, [])
    between = assumption_problems(given, study, instruments)
    if problems := [locate(one, source) for one in between]:
        raise ConfigError(problems)
    canonical = canonical_json(given.model_dump(mode="json"))
    return LoadedAssumptions(given, sha256_of(canonical))


def _titles_that_are_not_plain(tree: Plain) -> Iterator[DefinitionProblem]:
    # Only of files: an instrument that was stored before stays readable.
    title = tree.get("title") if isinstance(tree, dict) else None
    for language, text in title.items() if isinstance(title, dict) else ():
        if isinstance(text, str) and (problem := not_plain(text)) is not None:
            yield DefinitionProblem(
                ("title", language),
                f"The title ({language}) is not plain text. {problem}",
                text,
                remedy="Remove the character, or type the title again.",
            )


def _long_titles(tree: Plain) -> Iterator[DefinitionProblem]:
    """Yield a problem for each title that is too long for a page.

    Only of files: what was stored with such a title before stays readable.
    """
    title = tree.get("title") if isinstance(tree, dict) else None
    for language, text in title.items() if isinstance(title, dict) else ():
        if isinstance(text, str) and len(text) > LONGEST_TITLE:
            yield DefinitionProblem(
                ("title", language),
                f"The title ({language}) has {len(text)} characters.",
                text,
                f"at most {LONGEST_TITLE} characters",
                "Shorten it; the description has room for more.",
            )


def study_schema() -> Schema:
    """Return the JSON schema of study files, with the descriptions that problems quote."""
    return _STUDY.schema


def parse_study_json(canonical_json: str) -> StudyProtocol:
    """Parse a study stored as canonical JSON; raise ConfigError if it is invalid."""
    return with_avatar_lines(_parsed(_STUDY, canonical_json))


def instrument_as_json(instrument: Instrument) -> dict[str, Plain]:
    """Return an instrument's content with defaults, but without unused newer fields.

    So the hash of a stored instrument does not change with a release.
    """
    tree: dict[str, Plain] = _INSTRUMENT.adapter.dump_python(instrument, mode="json")
    items = cast("list[dict[str, Plain]]", tree["items"])
    scales = [item["scale"] for item in items if item["scale"] is not None]
    tree["items"] = [
        {key: value for key, value in item.items() if key != "scale" or value is not None}
        for item in items
    ]
    for scale in cast("list[dict[str, Plain]]", [*scales, tree["scale"] or {}]):
        if scale.get("step") == 1:
            del scale["step"]
    return tree


def parse_instrument_json(canonical_json: str) -> Instrument:
    """Parse an instrument stored as canonical JSON; raise ConfigError if it is invalid."""
    return _parsed(_INSTRUMENT, canonical_json)


class _Kind(Generic[_Value]):
    """A kind of file: how to validate its content, and the schema that explains problems."""

    def __init__(self, adapter: TypeAdapter[_Value]) -> None:
        self.adapter = adapter

    @cached_property
    def schema(self) -> Schema:
        return self.adapter.json_schema()

    def validate(self, tree: Plain) -> _Value:
        # Validated as JSON, so that a list may become a tuple and a word an enum, but nothing
        # else is converted.
        return self.adapter.validate_json(json.dumps(tree))


_STUDY = _Kind(TypeAdapter(StudyProtocol))
_INSTRUMENT = _Kind(TypeAdapter(Instrument))
_ASSUMPTIONS = _Kind(TypeAdapter(Assumptions))


def _validated(kind: _Kind[_Value], source: Source, found: list[ConfigProblem]) -> _Value:
    problems = [*source.problems, *found]
    if not isinstance(source.tree, dict):
        message = "The file is not a mapping of settings."
        remedy = "Begin with lines such as key: my-study."
        raise ConfigError([*problems, ConfigProblem("", 1, 1, message, remedy=remedy)])
    try:
        value = kind.validate(source.tree)
    except ValidationError as error:
        problems += explain(error, kind.schema, source)
        problems += _problems_without_unknown_keys(kind, error, source)
        raise ConfigError(problems) from error
    if problems:
        raise ConfigError(problems)
    return value


def _problems_without_unknown_keys(
    kind: _Kind[_Value], error: ValidationError, source: Source
) -> Iterable[ConfigProblem]:
    """Yield problems that appear only once unknown keys are removed.

    Unknown names in formulas are an example.
    """
    unknown = [one["loc"] for one in error.errors() if one["type"] in UNKNOWN_KEY]
    if len(unknown) != error.error_count():
        return
    cleaned = copy.deepcopy(source.tree)
    for place in unknown:
        remove(cleaned, place)
    try:
        kind.validate(cleaned)
    except ValidationError as later:
        yield from explain(later, kind.schema, source)


def _parsed(kind: _Kind[_Value], text: str) -> _Value:
    try:
        return kind.adapter.validate_json(text)
    except ValidationError as error:
        raise ConfigError(explain(error, kind.schema, Source())) from error
