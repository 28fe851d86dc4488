"""Apply one change as one replacement in the text, unless the layout is too unusual."""

from app.protocol.editing.change import Change
from app.protocol.editing.spans import Span
from app.protocol.editing.writing import block, entry, inline, item, scalar
from app.protocol.source import Path, Plain


def spliced(text: str, root: Span, change: Change) -> str | None:
    """Return the text after the change, or None if one replacement is not enough."""
    *_, last = change.path
    parent = root.at(change.path[:-1])
    span = root.at(change.path)
    in_flow = _is_in_flow(root, change.path)
    if change.action == "set" and span is not None:
        return _replace(text, span, change.value, in_flow=in_flow)
    if change.action == "insert" and isinstance(last, int):
        return _insert(text, root, change, parent)
    if parent is None or in_flow or parent.flow:
        return _in_brackets(text, parent, change)
    if change.action == "set":
        return _add_entry(text, parent, str(last), change.value)
    if span is None or len(parent.children) < 2:
        return None
    if change.action == "remove":
        return _cut(text, parent, span)
    return _moved(text, parent, change)


def _is_in_flow(root: Span, path: Path) -> bool:
    around = [root.at(path[:depth]) for depth in range(len(path))]
    return any(span is not None and span.flow for span in around)


def _replace(text: str, span: Span, value: Plain, *, in_flow: bool) -> str:
    if in_flow:
        return text[: span.start] + inline(value) + text[span.end :]
    lines = block(value, _indent(text, span), span.style)
    simple = span.kind == "scalar" and span.style not in ("|", ">") and len(lines) == 1
    if simple or (span.flow and len(lines) == 1):
        new = (
            scalar(value, span.style) if simple and not isinstance(value, dict | list) else lines[0]
        )
        gap = " " if span.start == span.end and text[span.start - 1 : span.start] == ":" else ""
        return text[: span.start] + gap + new + text[span.end :]
    after = _line_end(text, span.end)
    tail = text[span.end : after].strip()
    head = text[span.lead : min(_line_end(text, span.lead), span.start)].strip()
    notes = "".join(f"  {note}" for note in (head, tail) if note.startswith("#"))
    if text[span.own : span.own + 1] == "-" and span.lead == span.own + 1 and lines[0] == "":
        lines = [lines[1].lstrip(), *lines[2:]]
    lines[0] = (f" {lines[0]}" if lines[0] else "") + notes
    return text[: span.lead] + "\n".join(lines) + text[after:]


def _indent(text: str, span: Span) -> int:
    """Return the column of lines below the key or dash of the value."""
    column = span.own - (text.rfind("\n", 0, span.own) + 1)
    if span.kind in ("map", "list") and not span.flow and span.column > column:
        return span.column
    return column + 2


def _add_entry(text: str, parent: Span, key: str, value: Plain) -> str | None:
    if parent.kind != "map" or not parent.children:
        return None
    end = _line_end(text, parent.end)
    new = "\n".join(entry(key, value, parent.column))
    return text[:end] + "\n" + new + text[end:]


def _insert(text: str, root: Span, change: Change, parent: Span | None) -> str | None:
    *path, at = change.path
    if parent is None:
        made = Change(tuple(path), "set", [change.value])
        return spliced(text, root, made)
    if parent.flow or not parent.items or _is_in_flow(root, change.path):
        return None
    assert isinstance(at, int)  # noqa: S101 - the caller has looked
    spread = all(one.kind == "map" and not one.flow for one in parent.items)
    lines = "\n".join(item(change.value, parent.column, spread=spread))
    if at > 0:
        end = _line_end(text, parent.items[at - 1].end)
        return text[:end] + "\n" + lines + text[end:]
    start = _line_start(text, parent.items[0].own)
    return text[:start] + lines + "\n" + text[start:]


def _in_brackets(text: str, parent: Span | None, change: Change) -> str | None:
    """Change an entry of a mapping in braces.

    Return None for lists in brackets, which are rewritten.
    """
    if parent is None or parent.kind != "map" or not parent.entries:
        return None
    key = str(change.path[-1])
    keys = list(parent.entries)
    if change.action == "set":
        end = parent.children[-1].end
        return text[:end] + f", {inline(key)}: {inline(change.value)}" + text[end:]
    if change.action != "remove" or len(keys) < 2:
        return None
    at = keys.index(key)
    if at + 1 < len(keys):
        return text[: parent.entries[key].own] + text[parent.entries[keys[at + 1]].own :]
    return text[: parent.entries[keys[at - 1]].end] + text[parent.entries[key].end :]


def _cut(text: str, parent: Span, span: Span) -> str:
    """Remove the lines of the entry, or only up to the next key if it follows a dash."""
    start = _line_start(text, span.own)
    if not text[start : span.own].strip():
        return text[:start] + text[_line_end(text, span.end) + 1 :]
    later = [one for one in parent.children if one.own > span.own]
    return text[: span.own] + (text[later[0].own :] if later else text[span.end :])


def _moved(text: str, parent: Span, change: Change) -> str | None:
    """Reorder whole entries, each with the comments above it."""
    at = change.path[-1]
    starts = [_line_start(text, one.own) for one in parent.items]
    ends = [_line_end(text, one.end) for one in parent.items]
    own = [text[start : one.own] for start, one in zip(starts, parent.items, strict=True)]
    if not isinstance(at, int) or any(before.strip() for before in own):
        return None
    begins = [starts[0], *(end + 1 for end in ends[:-1])]
    pieces = [text[begin:end] for begin, end in zip(begins, ends, strict=True)]
    pieces.insert(change.to, pieces.pop(at))
    return text[: starts[0]] + "\n".join(pieces) + text[ends[-1] :]


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    end = text.find("\n", at)
    return len(text) if end == -1 else end
