"""Finding one's way in a JSON schema: which keys a place can have, and where the texts are."""

from collections.abc import Iterator, Mapping
from typing import Any

from app.protocol.source import Path, Plain

Schema = Mapping[str, Any]


def schema_at(root: Schema, tree: Plain, path: Path) -> Schema:
    """The schema of the place `path` leads to; empty where the schema says nothing."""
    node, value = _resolved(root, root, tree), tree
    for part in path:
        node, value = _child(root, node, value, part)
    return node


def marked_places(root: Schema, tree: Plain, mark: str) -> Iterator[tuple[Path, Plain]]:
    """Every value in the tree whose schema carries the mark, with its path."""

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
    """One step down, in the schema and in the value at once."""
    inner: Plain = None
    schema: Any = None
    if isinstance(part, int):
        inner = value[part] if isinstance(value, list) and part < len(value) else None
        schema = node.get("items")
    else:
        inner = value.get(part) if isinstance(value, dict) else None
        # Mappings with free keys: pydantic says it in one of two ways, by how keys are constrained.
        free = [*node.get("patternProperties", {}).values(), node.get("additionalProperties")]
        schema = node.get("properties", {}).get(part, free[0])
    return _resolved(root, schema if isinstance(schema, dict) else {}, inner), inner


def _resolved(root: Schema, node: Schema, value: Plain) -> Schema:
    """Follow references, the non-null side of an optional, and the value's own union member."""
    if "$ref" in node:
        name = str(node["$ref"]).rpartition("/")[2]
        beside = {key: said for key, said in node.items() if key != "$ref"}
        return _resolved(root, {**root["$defs"][name], **beside}, value)
    if "discriminator" in node:
        tags = node["discriminator"]
        tag = value.get(tags["propertyName"]) if isinstance(value, dict) else None
        target = tags["mapping"].get(tag) if isinstance(tag, str) else None
        return {} if target is None else _resolved(root, {"$ref": target}, value)
    for option in node.get("anyOf", ()):
        if option.get("type") != "null":
            return _resolved(root, option, value)
    return node
