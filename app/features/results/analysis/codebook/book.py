"""The complete codebook, as a data frame and as a Markdown page."""

from collections.abc import Sequence
from dataclasses import asdict, replace

import pandas as pd

from app.features.results.analysis.codebook.column import Column, Describe
from app.features.results.analysis.codebook.equipment import (
    CALIBRATIONS,
    CLOCK_MAPPING,
    CLOCK_PROBES,
    HEADSET_TESTS,
)
from app.features.results.analysis.codebook.headset import BODY_CALIBRATIONS, GOAL_STATES
from app.features.results.analysis.codebook.movement import (
    COMPLETIONS,
    CONTACTS,
    FINGER_SAMPLES,
    JOINT_ERROR_COURSE,
    JOINT_ERRORS,
    SAMPLES,
    STREAMS,
)
from app.features.results.analysis.codebook.quality import ALARMS, DOUBTS, QUALITY
from app.features.results.analysis.codebook.questionnaires import ANSWERS, CORRECTIONS, SCORES
from app.features.results.analysis.codebook.road import ROAD_CROSSINGS
from app.features.results.analysis.codebook.sessions import EVENTS, PHASES, SESSIONS
from app.features.results.analysis.codebook.trackers import (
    COMPANION_FRAMES,
    TRACKER_ALIGNMENTS,
    TRACKER_SAMPLES,
)
from app.features.results.analysis.codebook.wide import WIDE, WIDE_COLUMNS
from app.science.skeleton import FINGER_PARTS, JOINT_NAMES

_B = Describe("codebook")
TABLES: dict[str, str] = {
    "sessions": "One row per session: who, which order, when.",
    "phases": "One row per run of a timed phase, with what it came to.",
    "answers": "One row per item of a filled-in form.",
    "scores": "One row per score of a filled-in form.",
    "corrections": "One row per answer that was corrected later, with what it was before.",
    "contacts": "One row per contact of a body part with a surface.",
    "completions": "One row per completed task.",
    "joint_errors": "One row per phase, reference, joint and axis.",
    "joint_error_course": "One row per phase, reference and bin of active time.",
    "quality": "One row per phase and stream: what is wrong with its frames.",
    "doubts": "One row per thing that a headset said and that cannot be true.",
    "alarms": "One row per alarm that was raised, and one per alarm that was cleared.",
    "clock_probes": "One row per exchange of clock readings between a headset and the server.",
    "clock_mapping": "One row per segment of a headset's clock, brought to the server's.",
    "goal_states": "One row per change in how a headset knew the parts of the body.",
    "body_calibrations": "One row per calibration of a headset to the participant, and part.",
    "tracker_alignments": "One row per alignment of the lab's trackers with a headset, or its end.",
    "road_crossings": "One row per crossing of the study's road by a participant.",
    "events": "One row per event of a session's log: the audit trail.",
    "wide": "One row per participant who counts; wide_columns.csv describes the columns of values.",
    "wide_columns": "One row per column of values in wide.csv.",
    "calibrations": "One row per measurement of the equipment's own delay; of no one session.",
    "headset_tests": "One row per self-test of a headset and figure; of no one session.",
    "codebook": "One row per column of the other files.",
    "samples": "One file per session, one row per frame: target and actual body side by side.",
    "fingers": "One file per session that recorded fingers; one row per frame, as in samples.",
    "trackers": "One file per session that used the lab's trackers; one row per pose, as it came.",
    "companions": "One file per session that showed a companion; one row per pose as it was shown.",
}
"""The description of each table's rows, in the order of the export."""

CODEBOOK: tuple[Column, ...] = (
    *SESSIONS,
    *PHASES,
    *ANSWERS,
    *SCORES,
    *CORRECTIONS,
    *CONTACTS,
    *COMPLETIONS,
    *JOINT_ERRORS,
    *JOINT_ERROR_COURSE,
    *QUALITY,
    *DOUBTS,
    *ALARMS,
    *CLOCK_PROBES,
    *CLOCK_MAPPING,
    *GOAL_STATES,
    *BODY_CALIBRATIONS,
    *TRACKER_ALIGNMENTS,
    *ROAD_CROSSINGS,
    *EVENTS,
    *WIDE,
    *WIDE_COLUMNS,
    *CALIBRATIONS,
    *HEADSET_TESTS,
    _B.text(
        "table",
        "The file that the column is in; samples, fingers, trackers and companions stand for all "
        "files in these folders.",
    ),
    _B.text("column", "Name of the column."),
    _B.text("meaning", "What it holds."),
    _B.text("unit", "Its unit, if it has one."),
    _B.text("type", "How to read it.", "text, integer, number, boolean, time"),
    _B.text("levels", "Its range, or the words it can hold."),
    *SAMPLES,
    *FINGER_SAMPLES,
    *TRACKER_SAMPLES,
    *COMPANION_FRAMES,
)
PREFACE = """\
# Data dictionary

Every column of an export (`./run export`, `codebook.csv`). Generated from the codebook in
`app/features/results/analysis/codebook`; a test holds it to that.

Missing values are empty cells. Booleans are `true` and `false`, times are UTC in ISO 8601, angles
in degrees, lengths in metres, durations in seconds. Data of people, simulations and
tests are never summarised together: every table of data has the column `simulated`."""
_PER_PART = {
    "samples": (JOINT_NAMES, "Each of the 22 joints", "Joint"),
    "fingers": (FINGER_PARTS, "Each of the 30 finger parts", "Part"),
    "companions": (JOINT_NAMES, "Each of the 22 joints", "Joint"),
}
_BY_TABLE = {
    table: tuple(column for column in CODEBOOK if column.table == table) for table in TABLES
}


def columns_of(table: str, *, rules: bool = True) -> tuple[Column, ...]:
    """Return the columns of a table in their order.

    Without `rules`, the columns that exist only for studies with `valid_when` rules are left out.
    """
    columns = _BY_TABLE[table]
    return columns if rules else tuple(map(_plain, filter(_without_rules, columns)))


def codebook(*, rules: bool = True) -> tuple[Column, ...]:
    """Return every column of an export.

    Without `rules`, the columns that exist only for studies with `valid_when` rules are left out.
    """
    return CODEBOOK if rules else tuple(map(_plain, filter(_without_rules, CODEBOOK)))


def _without_rules(column: Column) -> bool:
    return not column.of_rules


def _plain(column: Column) -> Column:
    general_meaning = column.without_rules
    return column if general_meaning is None else replace(column, meaning=general_meaning)


def codebook_frame(*, rules: bool = True) -> pd.DataFrame:
    """Return the codebook as a data frame: table, column, meaning, unit, type, levels."""
    frame = pd.DataFrame([asdict(column) for column in codebook(rules=rules)])
    frame = frame.rename(columns={"name": "column"})
    return frame[[column.name for column in columns_of("codebook")]]


def data_dictionary() -> str:
    """Return the codebook as a Markdown page; the joints' columns are merged into one line each."""
    parts = [PREFACE]
    for table, rows in TABLES.items():
        parts += [f"## {table}", rows, _markdown(_folded(columns_of(table)))]
    return "\n\n".join(parts) + "\n"


def _folded(columns: Sequence[Column]) -> list[Column]:
    """Merge the columns of all joints of a stream, and of all quaternion parts, into one column."""
    folded: dict[str, Column] = {}
    for column in columns:
        short = _folded_column(column)
        folded.setdefault(short.name, short)
    return list(folded.values())


def _folded_column(column: Column) -> Column:
    if column.table not in _PER_PART:
        return column
    parts, every, short = _PER_PART[column.table]
    for stream in ("", *(f"{one}_" for one in STREAMS)):
        for part in parts:
            if column.name.startswith(f"{stream}{part}_q"):
                meaning = column.meaning.replace(f"{part} of", f"{every} of", 1)
                meaning = meaning.replace(f"part {column.name[-1]} ", "part w, x, y or z ", 1)
                return replace(column, name=f"{stream}<{short}>_q<w|x|y|z>", meaning=meaning)
    return column


def _markdown(columns: Sequence[Column]) -> str:
    lines = ["| Column | Type | Unit | Range | Meaning |", "|---|---|---|---|---|"]
    for column in columns:
        cells = (f"`{column.name}`", column.type, column.unit, column.levels, column.meaning)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines)
