"""The description of one exported column, and the columns that many tables share."""

from dataclasses import dataclass, replace
from typing import Literal

from app.protocol import TIMED_KINDS

_PHASE = "Whether the row may be analysed: the phase was finished and not redone or skipped"
ColumnType = Literal["text", "integer", "number", "boolean", "time"]


@dataclass(frozen=True)
class Column:
    """The description of one exported column.

    `of_rules`: the column exists only in exports with sessions of a study version that has rules
    for valid sessions (`valid_when`). `without_rules`: the meaning in all other exports, where it
    differs. `type`: text, integer, number (double precision unless the meaning says otherwise),
    boolean (true or false) or time (UTC, ISO 8601). `unit` is empty for a column without one.
    `levels` is the range of a number or the words a text column can hold.
    """

    table: str
    name: str
    type: ColumnType
    meaning: str
    unit: str = ""
    levels: str = ""
    of_rules: bool = False
    without_rules: str | None = None


@dataclass(frozen=True)
class Describe:
    """A factory of the columns of one table, so that the table's name need not be repeated."""

    table: str

    def text(self, name: str, meaning: str, levels: str = "") -> Column:
        """Return a text column."""
        return Column(self.table, name, "text", meaning, levels=levels)

    def integer(self, name: str, meaning: str, unit: str = "", levels: str = "") -> Column:
        """Return a column of integers."""
        return Column(self.table, name, "integer", meaning, unit, levels)

    def number(self, name: str, meaning: str, unit: str = "", levels: str = "") -> Column:
        """Return a column of floating-point numbers."""
        return Column(self.table, name, "number", meaning, unit, levels)

    def boolean(self, name: str, meaning: str) -> Column:
        """Return a column whose values are true or false."""
        return Column(self.table, name, "boolean", meaning, levels="true, false")

    def valid(self, meaning: str, without_rules: str) -> Column:
        """Return the column `valid`, with another meaning for studies without `valid_when`."""
        return replace(self.boolean("valid", meaning), without_rules=without_rules)

    def time(self, name: str, meaning: str) -> Column:
        """Return a column of timestamps in UTC."""
        return Column(self.table, name, "time", meaning, "UTC, ISO 8601")


def session_columns(table: str) -> tuple[Column, ...]:
    """Return the columns that identify a row's session, the first of every table of a study."""
    of = Describe(table)
    return (
        of.text("study_key", "The study."),
        of.integer(
            "study_version", "Version of the study that the session ran.", levels="1 and up"
        ),
        of.text("kind", "Who took part.", "people, simulated, test"),
        of.boolean("simulated", "Whether a simulation made the data."),
        of.text(
            "avatar",
            "How the body that the participant saw was moved.",
            "delayed_copy, physics",
        ),
        of.text("participant_code", "Pseudonym, unique within the study and kind."),
        of.text("session_id", "The visit."),
    )


def place_columns(table: str) -> tuple[Column, ...]:
    """Return the columns for block, position, limb and condition, empty outside the blocks."""
    of = Describe(table)
    return (
        of.integer(
            "block",
            "Which block of the session, in the order in which they were done: the period.",
            levels="1 and up",
        ),
        of.integer(
            "position",
            "Place of the phase within its block. Where it always goes with the same limb, limb "
            "and time cannot be told apart.",
            levels="1 and up",
        ),
        of.text("limb", "Which limb the task is done with.", "hand, foot"),
        of.text("condition", "Key of the condition in the study file."),
        of.number(
            "latency_ms",
            "Latency added on top of what the equipment has of its own.",
            "ms",
            "0 and up",
        ),
    )


def phase_columns(table: str) -> tuple[Column, ...]:
    """Return the columns that identify the phase of a row and say whether the row is valid."""
    of = Describe(table)
    return (
        of.integer("phase_id", "The phase within its session.", levels="1 and up"),
        of.text("phase_kind", "What kind of phase.", ", ".join(TIMED_KINDS)),
        *place_columns(table),
        of.integer(
            "attempt", "Which attempt at the step; redone steps count up.", levels="1 and up"
        ),
        of.valid(
            f"{_PHASE}, nothing that its headset said of it is known to be untrue (doubts.csv), "
            "and the session counts (valid in sessions.csv).",
            f"{_PHASE}, nothing that its headset said of it is known to be untrue (doubts.csv), "
            "and the session was neither aborted nor withdrawn.",
        ),
    )
