"""A change requested by a form: set or remove a value, insert it into a list, or move it there."""

import copy
from dataclasses import dataclass
from typing import Literal

from app.protocol.errors import ConfigError, ConfigProblem
from app.protocol.source import Path, Plain, path_text

Action = Literal["set", "remove", "insert", "move"]


@dataclass(frozen=True)
class Change:
    """One change of a file's text.

    `path` leads to the value: keys and list positions from 0. "set" writes `value` there, whether
    or not the key existed; "remove" deletes the key or list entry; "insert" puts `value` into the
    list before the last position of the path (its length appends; a missing list is created);
    "move" moves that list entry to the position `to`.
    """

    path: Path
    action: Action
    value: Plain = None
    to: int = 0


def applied(tree: Plain, change: Change) -> Plain:
    """Return the changed tree and leave `tree` unmodified.

    Raise ConfigError if the change is impossible.
    """
    after = copy.deepcopy(tree)
    if not change.path:
        raise _refusal(change, "The whole file cannot be changed in one step.")
    *parents, last = change.path
    node = after
    for depth, part in enumerate(parents):
        if change.action == "insert" and depth == len(parents) - 1 and isinstance(node, dict):
            node.setdefault(str(part), [])
        node = _child(node, part, change)
    if isinstance(node, dict) and isinstance(last, str):
        _in_map(node, last, change)
    elif isinstance(node, list) and isinstance(last, int):
        _in_list(node, last, change)
    else:
        raise _refusal(change, "There is no such place in the file.")
    return after


def _child(node: Plain, part: str | int, change: Change) -> Plain:
    if isinstance(node, dict) and isinstance(part, str) and part in node:
        return node[part]
    if isinstance(node, list) and isinstance(part, int) and 0 <= part < len(node):
        return node[part]
    raise _refusal(change, "There is no such place in the file.")


def _in_map(node: dict[str, Plain], key: str, change: Change) -> None:
    if change.action == "set":
        node[key] = copy.deepcopy(change.value)
    elif change.action == "remove" and key in node:
        del node[key]
    else:
        raise _refusal(change, f"The key {key!r} cannot be used here.")


def _in_list(node: list[Plain], at: int, change: Change) -> None:
    value = copy.deepcopy(change.value)
    if change.action == "insert" and 0 <= at <= len(node):
        node.insert(at, value)
    elif not 0 <= at < len(node):
        raise _refusal(change, f"The list has no entry {at}.")
    elif change.action == "set":
        node[at] = value
    elif change.action == "remove":
        del node[at]
    elif change.action == "move" and 0 <= change.to < len(node):
        node.insert(change.to, node.pop(at))
    else:
        raise _refusal(change, f"The list has no position {change.to}.")


def _refusal(change: Change, message: str) -> ConfigError:
    return ConfigError(
        [
            ConfigProblem(
                path_text(change.path) or ".", 0, 0, message, change.action,
                remedy="Reload the file; it may have changed since the form was shown.",
            )
        ]
    )  # fmt: skip


def same(one: Plain, other: Plain) -> bool:
    """Return whether two trees have the same meaning: 60 equals 60.0, but 1 does not equal true."""
    if isinstance(one, dict) and isinstance(other, dict):
        return list(one) == list(other) and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    return isinstance(one, bool) == isinstance(other, bool) and one == other
