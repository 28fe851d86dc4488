"""Where each value of a YAML text begins and ends, so that one can be replaced alone.

The end of a value is the end of its last character: trailing comments and blank lines belong to
nobody and stay. Offsets count characters of the text from 0.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from app.protocol.source import Path

_NO_MARK = yaml.Mark("", 0, 0, 0, None, 0)


@dataclass
class Span:
    """A value in the text. `column` counts from 0; `style` is the quote or block sign of a scalar.

    `lead`: where its place begins: after the colon of its key, or after the dash of its entry.
    `own`: where its key or its dash stands.
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
        """Its values in the order of the file."""
        return self.items if self.kind == "list" else list(self.entries.values())

    def at(self, path: Path) -> "Span | None":
        """The span that the path leads to, if there is one."""
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
    """The span of the document with all spans within; `text` must have passed `read_source`."""
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
            # Of a doubled key the first one counts, as in `read_source`.
            span.entries.setdefault(key, value)
        return event

    def _dash(self, after: int, item: Span, column: int) -> int:
        """The dash of a block entry: in the column of its list, between its neighbour and it."""
        line = self.text.rfind("\n", 0, item.start + 1) + 1
        while line > after:
            at = line + column
            if self.text[at : at + 1] == "-" and not self.text[line:at].strip():
                return at
            line = self.text.rfind("\n", 0, line - 1) + 1
        return self.text.find("-", after, item.start + 1)


def _end(event: yaml.Event) -> int:
    return (event.end_mark or _NO_MARK).index
