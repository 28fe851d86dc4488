"""Locate the start and end of each value of a YAML text, so that it can be replaced alone.

A value ends with its last character: trailing comments and blank lines belong to no value and are
preserved. Offsets count characters of the text from 0.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from app.protocol.source import Path

_NO_MARK = yaml.Mark("", 0, 0, 0, None, 0)


@dataclass
class Span:
    """The location of a value in the text.

    `column` counts from 0; `style` is the quotation mark or block indicator of a scalar. `lead`:
    where its slot begins: after the colon of its key, or after the dash of its entry. `own`: the
    position of its key or its dash.
    """

    start: int
    end: int
    column: int
    kind: str
    flow: bool
    style: str | None = None
    own: int = 0
    lead: int = 0
    entries: dict[str, "Span"] = field(default_factory=dict)
    items: list["Span"] = field(default_factory=list)

    @property
    def children(self) -> list["Span"]:
        """The spans of the values inside this value, in file order."""
        return self.items if self.kind == "list" else list(self.entries.values())

    def at(self, path: Path) -> "Span | None":
        """Return the span at the path, or None if there is none."""
        span: Span | None = self
        for part in path:
            if span is None:
                return None
            if isinstance(part, int):
                span = span.items[part] if part < len(span.items) else None
            else:
                span = span.entries.get(part)
        return span


def spans_of(text: str) -> Span:
    """Return the span of the document with all nested spans.

    `text` must have passed `read_source`.
    """
    events = yaml.parse(text, Loader=yaml.SafeLoader)
    next(events)
    next(events)
    return _Reader(text, events).node(next(events))


@dataclass
class _Reader:
    text: str
    events: Iterator[yaml.Event]

    def node(self, event: yaml.Event) -> Span:
        start = event.start_mark or _NO_MARK
        if isinstance(event, yaml.ScalarEvent):
            end = _end(event)
            if event.style in ("|", ">"):
                end = start.index + len(self.text[start.index : end].rstrip())
            return Span(start.index, end, start.column, "scalar", flow=False, style=event.style)
        flow = bool(getattr(event, "flow_style", False))
        kind = "list" if isinstance(event, yaml.SequenceStartEvent) else "map"
        span = Span(start.index, start.index, start.column, kind, flow)
        end_event = self._items(span) if kind == "list" else self._entries(span)
        last = span.children[-1].end if span.children else start.index
        span.end = _end(end_event) if flow else last
        return span

    def _items(self, span: Span) -> yaml.Event:
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            after = span.items[-1].end if span.items else span.start
            item = self.node(event)
            if not span.flow:
                item.own = self._dash(after, item, span.column)
                item.lead = item.own + 1
            span.items.append(item)
        return event

    def _entries(self, span: Span) -> yaml.Event:
        while not isinstance(event := next(self.events), yaml.MappingEndEvent):
            key = event.value if isinstance(event, yaml.ScalarEvent) else ""
            colon = self.text.find(":", _end(event))
            value = self.node(next(self.events))
            value.own, value.lead = (event.start_mark or _NO_MARK).index, colon + 1
            # The first of duplicate keys counts, as in `read_source`.
            span.entries.setdefault(key, value)
        return event

    def _dash(self, after: int, item: Span, column: int) -> int:
        """Return the position of a block entry's dash, in the column of its list."""
        line = self.text.rfind("\n", 0, item.start + 1) + 1
        while line > after:
            at = line + column
            if self.text[at : at + 1] == "-" and not self.text[line:at].strip():
                return at
            line = self.text.rfind("\n", 0, line - 1) + 1
        return self.text.find("-", after, item.start + 1)


def _end(event: yaml.Event) -> int:
    return (event.end_mark or _NO_MARK).index
