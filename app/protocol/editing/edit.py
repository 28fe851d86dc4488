"""Change a file's text while preserving comments, order, quotes and indentation elsewhere.

Each change replaces the smallest part of the text that contains the value. The result is parsed and
must have exactly the intended content; if not (because of an unusual layout), the enclosing value
is rewritten, and so on outwards. So a change is either correct or refused.
"""

from collections.abc import Iterable, Iterator

from app.protocol.editing.change import Change, applied, same
from app.protocol.editing.spans import Span, spans_of
from app.protocol.editing.splice import spliced
from app.protocol.errors import ConfigError, ConfigProblem
from app.protocol.source import Path, Plain, path_text, read_source


def edit_text(text: str, changes: Iterable[Change]) -> str:
    """Return the text after the changes, applied one after the other.

    Raises ConfigError for a text that cannot be parsed or exceeds the limits of `read_source`, and
    for a change that is impossible in it.
    """
    tree = read_source(text).tree
    for change in changes:
        intended = applied(tree, change)
        text = _changed(text, change, intended)
        tree = intended
    return text


def _changed(text: str, change: Change, intended: Plain) -> str:
    root = spans_of(text)
    for candidate in _candidates(text, root, change, intended):
        try:
            if same(read_source(candidate).tree, intended):
                return candidate
        except ConfigError:
            continue
    place = root.at(change.path) or root
    line = text.count("\n", 0, place.start) + 1
    raise ConfigError(
        [
            ConfigProblem(
                path_text(change.path), line, 1, "This place cannot be changed from a form.",
                remedy="Change it in the text, because of its layout or its length.",
            )
        ]
    )  # fmt: skip


def _candidates(text: str, root: Span, change: Change, intended: Plain) -> Iterator[str]:
    fine = spliced(text, root, change)
    if fine is not None:
        yield fine
    path: Path = change.path[:-1]
    while path:
        whole = spliced(text, root, Change(path, "set", _value(intended, path)))
        if whole is not None:
            yield whole
        path = path[:-1]


def _value(tree: Plain, path: Path) -> Plain:
    for part in path:
        if isinstance(tree, list) and isinstance(part, int):
            tree = tree[part]
        elif isinstance(tree, dict):
            tree = tree[str(part)]
    return tree
