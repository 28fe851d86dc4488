"""Read operations from JSON that people write: every problem with its place and its remedy."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from pydantic import TypeAdapter, ValidationError

from app.protocol.avatar_editing.operation import AvatarOperation
from app.protocol.avatar_editing.operations import operation_models
from app.protocol.errors import ConfigError
from app.protocol.explanations import did_you_mean, explain, locate
from app.protocol.source import Path, Source, path_text, read_json
from app.science.instruments import DefinitionProblem


def read_operations(text: str) -> tuple[AvatarOperation, ...]:
    """Return the operation in a text, or those of a list, in their order.

    Raises ConfigError with every problem; the path of a problem in a list begins with its position.
    """
    source = read_json(text)
    tree: Any = source.tree
    several = isinstance(tree, list)
    found: list[AvatarOperation] = []
    problems = list(source.problems)
    for at, one in enumerate(tree if several else [tree]):
        path: Path = (at,) if several else ()
        try:
            found.append(_operation(one, path, source))
        except ConfigError as error:
            problems += error.problems
    if problems:
        raise ConfigError(problems)
    return tuple(found)


def _operation(tree: Any, path: Path, source: Source) -> AvatarOperation:
    models = operation_models()
    name = tree.get("operation") if isinstance(tree, dict) else None
    model = models.get(name) if isinstance(name, str) else None
    if model is None:
        raise ConfigError([locate(_unknown(tree, name, path), source)])
    try:
        return TypeAdapter(model).validate_json(json.dumps(tree))
    except ValidationError as error:
        inside = _inside(source, path)
        raise ConfigError(
            replace(one, path=_joined(path, one.path))
            for one in explain(error, model.model_json_schema(), inside)
        ) from None


def _inside(source: Source, path: Path) -> Source:
    """Return the part of a source below a path as a source of its own, with the same places."""
    depth = len(path)

    def below(places: Iterable[Path]) -> Iterator[Path]:
        return (one for one in places if one[:depth] == path)

    tree: Any = source.tree
    for step in path:
        tree = tree[step]
    return Source(
        tree,
        {one[depth:]: source.values[one] for one in below(source.values)},
        {one[depth:]: source.keys[one] for one in below(source.keys)},
        refused={one[depth:] for one in below(source.refused)},
    )


def _joined(path: Path, inner: str) -> str:
    separator = "." if path and inner and not inner.startswith("[") else ""
    return f"{path_text(path)}{separator}{inner}"


def _unknown(tree: Any, name: object, path: Path) -> DefinitionProblem:
    names = list(operation_models())
    if not isinstance(tree, dict):
        message, value = "An operation is a JSON object.", tree
    elif name is None:
        message, value = "The key 'operation' is missing.", None
    else:
        message, value = f"There is no operation {name!r}.", name
    remedy = f"{did_you_mean(name or '', names)}Operations are {', '.join(names)}."
    where: Path = (*path, "operation") if name is not None else path
    return DefinitionProblem(where, message, value, names, remedy)
