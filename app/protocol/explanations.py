"""Convert pydantic's errors to problems that a person can correct, each with its place."""

import difflib
from collections.abc import Iterable, Sized

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from app.protocol.errors import ConfigProblem
from app.protocol.schema import Schema, schema_at
from app.protocol.source import Path, Plain, Source, path_text
from app.science.instruments import DefinitionProblem, InstrumentDefinitionError, shortened

UNKNOWN_KEY = ("extra_forbidden", "unexpected_keyword_argument")
"""The error types of pydantic for a key that a model, or a dataclass, does not have."""

_EXPECTED = {
    "string_type": ("text", "Write text; put it in quotes if it looks like a number."),
    "int_type": ("a whole number", "Write a whole number without quotes."),
    "int_from_float": ("a whole number", "Write a whole number."),
    "float_type": ("a number", "Write a number without quotes."),
    "bool_type": ("true or false", "Write true or false, without quotes."),
    "tuple_type": ("a list", "Write a list: [a, b] or one line for each with a dash."),
    "model_type": ("a mapping", "Write keys with values, indented below it."),
    "model_attributes_type": ("a mapping", "Write keys with values, indented below it."),
    "dataclass_type": ("a mapping", "Write keys with values, indented below it."),
    "dict_type": ("a mapping", "Write keys with values, indented below it."),
    "mapping_type": ("a mapping of languages", "Write for example {en: ..., de: ...}."),
}
_NUMBERS = ("int_type", "float_type")
_BOUNDS = (
    ("minimum", "at least"),
    ("exclusiveMinimum", "above"),
    ("maximum", "at most"),
    ("exclusiveMaximum", "below"),
)
_MAX_SHOWN = 200
MOST_EXPLAINED = 200
"""How many problems are explained; the others are counted."""
_LIMITS = {
    "greater_than": ("gt", "above"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "below"),
    "less_than_equal": ("le", "at most"),
}


def explain(error: ValidationError, schema: Schema, source: Source) -> Iterable[ConfigProblem]:
    """Yield each pydantic error as a problem with path, line, column, valid values and remedy.

    Of thousands, which take seconds to explain and nobody reads, only the first are explained.
    """
    findings = error.errors(include_url=False)
    if len(findings) > MOST_EXPLAINED:
        yield ConfigProblem(
            "", 1, 1, f"There are {len(findings)} problems; the first {MOST_EXPLAINED} are listed.",
            remedy="Correct these and check it again, or make sure that it is the right file.",
        )  # fmt: skip
    for details in findings[:MOST_EXPLAINED]:
        path = _tree_path(details["loc"], source.tree, missing=details["type"] == "missing")
        if _is_echo(details, findings) or path in source.refused:
            continue
        cause = details.get("ctx", {}).get("error")
        if isinstance(cause, InstrumentDefinitionError):
            yield from (locate(problem, source) for problem in cause.problems)
        else:
            found = _finding(details, path, schema, source.tree)
            yield locate(found, source, at_key=details["type"] in UNKNOWN_KEY)


def locate(problem: DefinitionProblem, source: Source, *, at_key: bool = False) -> ConfigProblem:
    """Return the problem with the line and column of its value, or of its key."""
    mark = source.place(problem.path, of_key=at_key)
    return ConfigProblem(
        path_text(problem.path), mark.line, mark.column,
        problem.message, _shown(problem.value), problem.valid, problem.remedy,
    )  # fmt: skip


def did_you_mean(given: object, valid: Iterable[str]) -> str:
    """Return the question for the valid word that is most like a given one; empty if none is.

    Like it are words that differ in a few letters, and those that begin with it.
    """
    words, typed = list(valid), str(given)[:_MAX_SHOWN]
    close = difflib.get_close_matches(typed, words, n=1) or [
        word for word in words if typed and word.startswith(typed)
    ]
    return f"Did you mean {close[0]!r}? " if close and close[0] != typed else ""


def _words(valid: object) -> list[str]:
    return [one for one in valid if isinstance(one, str)] if isinstance(valid, list) else []


def _shown(value: object) -> object:
    """Shorten a value for a message: whole sections are left out, long texts cut."""
    if isinstance(value, dict) or (isinstance(value, list) and len(str(value)) > _MAX_SHOWN):
        return None
    return shortened(value, _MAX_SHOWN)


def _finding(details: ErrorDetails, path: Path, schema: Schema, tree: Plain) -> DefinitionProblem:
    kind, given, context = details["type"], details.get("input"), details.get("ctx", {})
    if kind == "missing":
        return _missing(path, schema_at(schema, tree, path))
    if kind in UNKNOWN_KEY:
        return _unknown_key(path, given, schema_at(schema, tree, path[:-1]))
    if kind == "refused":
        value = given if context["value"] is None else context["value"]
        inner = (*path, *context["at"])
        remedy = f"{did_you_mean(value, _words(context['valid']))}{context['remedy']}"
        return DefinitionProblem(inner, context["said"], value, context["valid"], remedy)
    if kind in _NUMBERS and given in ("", None):
        return _missing_number(path, given, schema_at(schema, tree, path))
    if kind in _EXPECTED:
        expected, remedy = _EXPECTED[kind]
        return DefinitionProblem(
            path, f"Expected {expected}, got {_named(given)}.", given, expected, remedy
        )
    if kind in _LIMITS:
        limit, words = _LIMITS[kind]
        valid = f"{words} {context[limit]:g}"
        return DefinitionProblem(
            path, f"{given} is out of range.", given, valid, f"Give a value {valid}."
        )
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        return _wrong_tag(path, given, context, schema, tree)
    return _other(path, details, schema_at(schema, tree, path))


def _missing(path: Path, schema: Schema) -> DefinitionProblem:
    description = schema.get("description")
    if isinstance(path[-1], int):
        message = f"The list ends after {path[-1]} values."
        return DefinitionProblem(path, message, remedy="Add the missing values.")
    remedy = f"Add {path[-1]}" + (f": {_clause(description)}." if _is_short(description) else ".")
    return DefinitionProblem(path, f"The key {path[-1]!r} is missing.", None, description, remedy)


def _missing_number(path: Path, given: object, schema: Schema) -> DefinitionProblem:
    """Describe a number that is not there yet, such as the emptied field of a form."""
    whole = "a whole number" if schema.get("type") == "integer" else "a number"
    low, high = schema.get("minimum"), schema.get("maximum")
    if low is not None and high is not None:
        limits = f" from {low:g} to {high:g}"
    else:
        bounds = [f"{words} {schema[bound]:g}" for bound, words in _BOUNDS if bound in schema]
        limits = f" {', '.join(bounds)}" if bounds else ""
    description = schema.get("description")
    valid = description if _is_short(description) else f"{whole}{limits}"
    wanted = f"{whole}{limits}" if limits or valid == whole else f"{whole}: {valid}"
    return DefinitionProblem(path, "A number is missing here.", given, valid, f"Give {wanted}.")


def _unknown_key(path: Path, given: object, schema: Schema) -> DefinitionProblem:
    valid = sorted(schema.get("properties", {}))
    remedy = f"{did_you_mean(path[-1], valid)}Valid keys here: {', '.join(valid)}."
    return DefinitionProblem(path, f"The key {path[-1]!r} is not valid here.", given, valid, remedy)


def _wrong_tag(
    path: Path, given: object, context: dict[str, object], schema: Schema, tree: Plain
) -> DefinitionProblem:
    tag = str(context["discriminator"]).strip("'")
    steps = schema_at(schema, tree, path[:-1]).get("items", {})
    valid = sorted(steps.get("discriminator", {}).get("mapping", {}))
    value = given.get(tag) if isinstance(given, dict) else given
    message = (
        f"{tag} is {value!r}, which is not valid." if value else f"The key {tag!r} is missing."
    )
    remedy = f"{did_you_mean(value, valid)}Valid: {', '.join(valid)}."
    return DefinitionProblem((*path, tag), message, value, valid, remedy)


def _other(path: Path, details: ErrorDetails, schema: Schema) -> DefinitionProblem:
    """Describe other errors, such as lengths and patterns, by pydantic's message and the schema."""
    given, context = details.get("input"), details.get("ctx", {})
    valid = schema.get("enum") or context.get("expected") or schema.get("description")
    if "const" in schema:
        valid = schema["const"]
    words = ", ".join(map(str, valid)) if isinstance(valid, list) else valid
    remedy = f"Valid: {_clause(words)}." if words else "Correct it."
    if details["type"] in ("too_short", "too_long"):
        limits = (("at least", context.get("min_length")), ("at most", context.get("max_length")))
        valid = " and ".join(f"{words} {limit}" for words, limit in limits if limit is not None)
        # Pydantic counts what is too long only where it has a length without being read to its end.
        count = context.get("actual_length") or (len(given) if isinstance(given, Sized) else None)
        message = "There are too many entries." if count is None else f"There are {count} entries."
        remedy = f"Give {valid}."
    elif isinstance(given, str):
        message = f"{given[:80]!r} is not valid here."
    else:
        message = f"{details['msg']}."
    return DefinitionProblem(path, message, given, valid, remedy)


def _is_echo(details: ErrorDetails, findings: list[ErrorDetails]) -> bool:
    """Return whether a list is reported as too short only because its members are invalid."""
    loc = details["loc"]
    return details["type"] == "too_short" and any(
        len(other["loc"]) > len(loc) and other["loc"][: len(loc)] == loc for other in findings
    )


def remove(tree: Plain, loc: tuple[int | str, ...]) -> None:
    """Remove the key at pydantic's location from the tree, in place."""
    *parents, key = _tree_path(loc, tree)
    for part in parents:
        tree = _inside(tree, part)
    if isinstance(tree, dict):
        tree.pop(str(key), None)


def _inside(node: Plain, part: str | int) -> Plain:
    if isinstance(node, list) and isinstance(part, int):
        return node[part]
    return node[str(part)] if isinstance(node, dict) else None


def _tree_path(loc: tuple[int | str, ...], tree: Plain, *, missing: bool = False) -> Path:
    """Return pydantic's location without parts that are not in the file (the tags of unions).

    `missing`: the last part does not exist, which is the problem.
    """
    path: Path = ()
    node: Plain = tree
    for at, part in enumerate(loc, start=1):
        if isinstance(node, dict) and part in node:
            node, path = node[str(part)], (*path, part)
        elif isinstance(node, list) and isinstance(part, int) and part < len(node):
            node, path = node[part], (*path, part)
        elif missing and at == len(loc):
            path = (*path, part)
    return path


def _named(value: object) -> str:
    names = {dict: "a mapping", list: "a list", type(None): "nothing", bool: "true or false"}
    kind = names.get(type(value))
    return kind or repr(value)[:80]


def _clause(description: object) -> str:
    """Return a description without its full stop, for the end of a sentence that has its own."""
    return str(description).removesuffix(".")


def _is_short(description: object) -> bool:
    """Return whether a description fits into a sentence.

    Those of fields do, the docstrings of models do not.
    """
    return isinstance(description, str) and "\n" not in description and len(description) < 120
