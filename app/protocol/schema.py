"""Navigate a JSON schema: the keys that are valid at a place, and the places of texts."""

from collections.abc import Iterator, Mapping
from typing import Any

from app.protocol.source import Path, Plain

Schema = Mapping[str, Any]


def schema_at(root: Schema, tree: Plain, path: Path) -> Schema:
    """Return the schema of the place at `path`; empty if there is none."""
    node, value = _resolved(root, root, tree), tree
    for part in path:
        node, value = _child(root, node, value, part)
    return node


def marked_places(root: Schema, tree: Plain, mark: str) -> Iterator[tuple[Path, Plain]]:
    """Yield every value in the tree whose schema has the mark, with its path."""

    def walk(node: Schema, value: Plain, path: Path) -> Iterator[tuple[Path, Plain]]:
        if mark in node:
            yield path, value
        elif isinstance(value, dict):
            for key in value:
                yield from walk(*_child(root, node, value, key), (*path, key))
        elif isinstance(value, list):
            for index in range(len(value)):
                yield from walk(*_child(root, node, value, index), (*path, index))

    yield from walk(_resolved(root, root, tree), tree, ())


def _child(root: Schema, node: Schema, value: Plain, part: str | int) -> tuple[Schema, Plain]:
    """Descend one level in the schema and in the value."""
    inner: Plain = None
    schema: Any = None
    if isinstance(part, int):
        inner = value[part] if isinstance(value, list) and part < len(value) else None
        schema = node.get("items")
    else:
        inner = value.get(part) if isinstance(value, dict) else None
        # Mappings with arbitrary keys: pydantic uses either keyword, depending on the keys'
        # constraints.
        free = [*node.get("patternProperties", {}).values(), node.get("additionalProperties")]
        schema = node.get("properties", {}).get(part, free[0])
    return _resolved(root, schema if isinstance(schema, dict) else {}, inner), inner


def _resolved(root: Schema, node: Schema, value: Plain) -> Schema:
    """Resolve references, the non-null option of an optional, and the value's union member."""
    if "$ref" in node:
        name = str(node["$ref"]).rpartition("/")[2]
        siblings = {key: keyword for key, keyword in node.items() if key != "$ref"}
        return _resolved(root, {**root["$defs"][name], **siblings}, value)
    if "discriminator" in node:
        tags = node["discriminator"]
        tag = value.get(tags["propertyName"]) if isinstance(value, dict) else None
        target = tags["mapping"].get(tag) if isinstance(tag, str) else None
        return {} if target is None else _resolved(root, {"$ref": target}, value)
    for option in node.get("anyOf", ()):
        if option.get("type") != "null":
            return _resolved(root, option, value)
    return node
