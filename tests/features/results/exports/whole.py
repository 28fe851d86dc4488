"""Read a whole export in tests: its files by name, and their rows."""

import csv
import io
from pathlib import Path
from typing import Any

from app.database import Database
from app.features.results.exports.writing.service import Exported, export_study
from tests.features.builders import NOW, STUDY

TABLES = (
    *("sessions", "phases", "answers", "scores", "contacts", "completions", "joint_errors"),
    "joint_error_course",
)
MORE = (
    "corrections",
    "events",
    "quality",
    "doubts",
    "alarms",
    "clock_probes",
    "clock_mapping",
    "goal_states",
    "body_calibrations",
    "tracker_alignments",
    "road_crossings",
    "calibrations",
    "headset_tests",
    "wide",
    "wide_columns",
    "codebook",
)
FILES = {*(f"{name}.csv" for name in (*TABLES, *MORE)), "README.txt"}


def export(database: Database, to: Path, **options: Any) -> Exported:
    """Export the study into a folder."""
    with database.reading() as db:
        return export_study(db, STUDY, options.pop("kind", "people"), to, now=NOW, **options)


def tree_of(folder: Path) -> dict[str, bytes]:
    """Return the content of every file in a folder by its relative path."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def rows_of(data: bytes) -> list[dict[str, str]]:
    """Return the rows of a CSV file."""
    return list(csv.DictReader(io.StringIO(data.decode(), newline="")))
