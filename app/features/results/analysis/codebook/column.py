"""One column of an export, described once."""

from dataclasses import dataclass
from typing import Literal

ColumnType = Literal["text", "integer", "number", "boolean", "time"]


@dataclass(frozen=True)
class Column:
    """What a column holds.

    `type`: text, integer, number (double precision unless the meaning says otherwise), boolean
    (true or false) or time (UTC, ISO 8601). `unit` is empty for a column without one. `levels` is
    the range of a number or the words a text column can hold.
    """

    table: str
    name: str
    type: ColumnType
    meaning: str
    unit: str = ""
    levels: str = ""


@dataclass(frozen=True)
class Describe:
    """Writes the columns of one table without repeating its name."""

    table: str

    def text(self, name: str, meaning: str, levels: str = "") -> Column:
        """A column of words."""
        return Column(self.table, name, "text", meaning, levels=levels)

    def integer(self, name: str, meaning: str, unit: str = "", levels: str = "") -> Column:
        """A column of whole numbers."""
        return Column(self.table, name, "integer", meaning, unit, levels)

    def number(self, name: str, meaning: str, unit: str = "", levels: str = "") -> Column:
        """A column of numbers."""
        return Column(self.table, name, "number", meaning, unit, levels)

    def boolean(self, name: str, meaning: str) -> Column:
        """A column of true and false."""
        return Column(self.table, name, "boolean", meaning, levels="true, false")

    def time(self, name: str, meaning: str) -> Column:
        """A column of moments."""
        return Column(self.table, name, "time", meaning, "UTC, ISO 8601")
