"""Measure the export of twelve sessions as tidy CSV, compared with `pandas.DataFrame.to_csv`."""

import time
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from app.database import Database, open_database
from app.features.results.exports.writing import export_study
from app.schema_revisions import migrate
from app.wire import BODY_STREAMS
from tests.benchmarks.headsets import FRAMES_PER_BATCH, movement
from tests.benchmarks.report import Figure
from tests.features.builders import NOW, STUDY, SessionSpec, build_session, build_study
from tests.features.movement_builders import store_chunks

SESSIONS = 12
FRAMES = 50_880
"""The frames of a session in real time: 9.4 min at 90 Hz."""
PHASES = 7


def figures(folder: Path) -> list[Figure]:
    """Export twelve generated simulated sessions; the peer writes the samples of one of them."""
    url = f"sqlite:///{folder / 'study.sqlite'}"
    migrate(url)
    database = open_database(url)
    values = _long_movement()
    try:
        _build(database, values)
        began_s = time.monotonic()
        with database.reading() as db:
            export_study(db, STUDY, "simulated", folder / "csv", now=NOW)
        duration_s = time.monotonic() - began_s
    finally:
        database.close()
    size = sum(path.stat().st_size for path in (folder / "csv").rglob("*") if path.is_file())
    rows = SESSIONS * FRAMES
    peer_rows_per_s = FRAMES / _with_pandas(values, folder / "pandas.csv")
    name = f"export of {SESSIONS} sessions, {rows:,} rows of 187 columns"
    peer = "pandas to_csv of the same samples"
    return [
        Figure("export", name, duration_s, "s", peer, rows / peer_rows_per_s),
        Figure("export", "size", size / 2**20, "MiB"),
        Figure("export", "rows", rows / duration_s, "1/s", peer, peer_rows_per_s),
        Figure("export", "bytes", size / 2**20 / duration_s, "MiB/s"),
    ]


def _long_movement() -> NDArray[np.float32]:
    """Return smooth movement of a session's length, (FRAMES, 91)."""
    pieces = [movement(seed)[:-FRAMES_PER_BATCH] for seed in range(-(-FRAMES // 900))]
    return np.concatenate(pieces)[:FRAMES]


def _build(database: Database, values: NDArray[np.float32]) -> None:
    """Build rows as the server would store them; both streams carry the same movement."""
    with database.writing() as db:
        build_study(db)
    for number in range(SESSIONS):
        with database.writing() as db:
            session = build_session(db, SessionSpec(f"SIM-{number + 1:02}", kind="simulated"))
            for stream in BODY_STREAMS:
                for phase, seqs in enumerate(np.array_split(np.arange(FRAMES), PHASES), start=1):
                    rows = values[seqs[0] : seqs[-1] + 1]
                    store_chunks(db, session.id, stream, seqs.tolist(), rows, phase_id=phase)


def _with_pandas(values: NDArray[np.float32], path: Path) -> float:
    """Return the seconds that pandas takes to write one session's samples from memory."""
    both = pd.DataFrame(np.concatenate((values, values), axis=1))
    began_s = time.monotonic()
    both.to_csv(path, index=False)
    return time.monotonic() - began_s
