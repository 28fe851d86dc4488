"""XML text of which every byte is decided: element by element, attribute by attribute."""

from collections.abc import Iterable
from xml.sax.saxutils import quoteattr

Value = str | float | Iterable[float]
_INDENT = "  "


def number(value: float) -> str:
    """Twelve digits, more than any measure has and fewer than machines may disagree about."""
    text = f"{value:.12g}"
    return "0" if text == "-0" else text


class Element:
    """One XML element; attributes and children stay in the order they were given."""

    def __init__(self, tag: str, /, **attributes: Value | None) -> None:
        self._tag = tag
        self._attributes = {
            name.rstrip("_"): _text(value)
            for name, value in attributes.items()
            if value is not None
        }
        self._children: list[Element] = []

    def add(self, tag: str, /, **attributes: Value | None) -> "Element":
        """Append a child and return it."""
        child = Element(tag, **attributes)
        self._children.append(child)
        return child

    def lines(self, depth: int = 0) -> Iterable[str]:
        """The element as lines of text."""
        pad = _INDENT * depth
        words = "".join(f" {name}={quoteattr(text)}" for name, text in self._attributes.items())
        if not self._children:
            yield f"{pad}<{self._tag}{words}/>"
            return
        yield f"{pad}<{self._tag}{words}>"
        for child in self._children:
            yield from child.lines(depth + 1)
        yield f"{pad}</{self._tag}>"

    def text(self) -> str:
        """The whole document."""
        return "\n".join(self.lines()) + "\n"


def _text(value: Value) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, int | float):
        return number(value)
    return " ".join(number(part) for part in value)
