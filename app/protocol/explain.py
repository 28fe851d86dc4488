"""From pydantic's findings to problems that a person can act on, each at its place in the file."""

import difflib
from collections.abc import Iterable

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from app.protocol.errors import ConfigProblem
from app.protocol.schema import Schema, schema_at
from app.protocol.source import Path, Plain, Source, path_text
from app.science.instruments import DefinitionProblem, InstrumentDefinitionError

_WANTED = {
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
_LIMITS = {
    "greater_than": ("gt", "above"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "below"),
    "less_than_equal": ("le", "at most"),
}


def explain(error: ValidationError, schema: Schema, source: Source) -> Iterable[ConfigProblem]:
    """Each finding of pydantic as a problem with its path, line, column, validity and remedy."""
    findings = error.errors(include_url=False)
    for details in findings:
        path = _tree_path(details["loc"], source.tree, missing=details["type"] == "missing")
        if _is_echo(details, findings) or path in source.refused:
            continue
        cause = details.get("ctx", {}).get("error")
        if isinstance(cause, InstrumentDefinitionError):
            yield from (locate(problem, source) for problem in cause.problems)
        else:
            found = _finding(details, path, schema, source.tree)
            yield locate(found, source, at_key=details["type"] == "extra_forbidden")


def locate(problem: DefinitionProblem, source: Source, *, at_key: bool = False) -> ConfigProblem:
    """The problem with the line and column of its value, or of its key."""
    mark = source.place(problem.path, of_key=at_key)
    return ConfigProblem(
        path_text(problem.path), mark.line, mark.column,
        problem.message, problem.value, problem.valid, problem.remedy,
    )  # fmt: skip


def _finding(details: ErrorDetails, path: Path, schema: Schema, tree: Plain) -> DefinitionProblem:
    kind, given, context = details["type"], details.get("input"), details.get("ctx", {})
    if kind == "missing":
        return _missing(path, schema_at(schema, tree, path))
    if kind == "extra_forbidden":
        return _unknown_key(path, given, schema_at(schema, tree, path[:-1]))
    if kind == "refused":
        value = given if context["value"] is None else context["value"]
        return DefinitionProblem(path, context["said"], value, context["valid"], context["remedy"])
    if kind in _WANTED:
        wanted, remedy = _WANTED[kind]
        return DefinitionProblem(
            path, f"Expected {wanted}, got {_named(given)}.", given, wanted, remedy
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
    remedy = f"Add {path[-1]}" + (f": {description}." if _is_short(description) else ".")
    return DefinitionProblem(path, f"The key {path[-1]!r} is missing.", None, description, remedy)


def _unknown_key(path: Path, given: object, schema: Schema) -> DefinitionProblem:
    valid = sorted(schema.get("properties", {}))
    close = difflib.get_close_matches(str(path[-1]), valid, n=1)
    remedy = f"Did you mean {close[0]!r}? " if close else ""
    remedy += f"Valid keys here: {', '.join(valid)}."
    return DefinitionProblem(path, f"The key {path[-1]!r} is not known here.", given, valid, remedy)


def _wrong_tag(
    path: Path, given: object, context: dict[str, object], schema: Schema, tree: Plain
) -> DefinitionProblem:
    tag = str(context["discriminator"]).strip("'")
    steps = schema_at(schema, tree, path[:-1]).get("items", {})
    valid = sorted(steps.get("discriminator", {}).get("mapping", {}))
    value = given.get(tag) if isinstance(given, dict) else given
    close = difflib.get_close_matches(str(value), valid, n=1)
    remedy = f"Did you mean {close[0]!r}? " if close else ""
    message = (
        f"{tag} is {value!r}, which is not known." if value else f"The key {tag!r} is missing."
    )
    remedy += f"Valid: {', '.join(valid)}."
    return DefinitionProblem((*path, tag), message, value, valid, remedy)


def _other(path: Path, details: ErrorDetails, schema: Schema) -> DefinitionProblem:
    """Lengths, patterns, fixed words: pydantic's own sentence, and what the schema says."""
    given, context = details.get("input"), details.get("ctx", {})
    valid = schema.get("enum") or context.get("expected") or schema.get("description")
    if "const" in schema:
        valid = schema["const"]
    words = ", ".join(map(str, valid)) if isinstance(valid, list) else valid
    remedy = f"Valid: {words}." if words else "Correct it."
    if isinstance(given, str):
        message = f"{given[:80]!r} is not valid here: {details['msg'].lower()}."
    else:
        message = f"{details['msg']}."
    return DefinitionProblem(path, message, given, valid, remedy)


def _is_echo(details: ErrorDetails, findings: list[ErrorDetails]) -> bool:
    """Whether a list is called too short only because its members were refused."""
    loc = details["loc"]
    return details["type"] == "too_short" and any(
        len(other["loc"]) > len(loc) and other["loc"][: len(loc)] == loc for other in findings
    )


def remove(tree: Plain, loc: tuple[int | str, ...]) -> None:
    """Take the key at pydantic's location out of the tree, in place."""
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
    """Pydantic's location without the steps that are not in the file (the tags of unions).

    `missing`: the last step is not there, because that is the problem.
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


def _is_short(description: object) -> bool:
    """Field descriptions fit into a sentence; docstrings of whole models do not."""
    return isinstance(description, str) and "\n" not in description and len(description) < 120
