"""The dashboard of a study: its valid rows, drawn.

People's, simulated and test sessions are never drawn together. In a blinded study only completed
sessions are drawn, so that nobody who still runs a session can learn its latencies here.
"""

from collections.abc import Iterator

import pandas as pd
from sqlalchemy.orm import Session

from app.features.analysis.figures import (
    Drawing,
    completions_drawing,
    contacts_drawing,
    embodiment_drawings,
    joint_error_drawing,
    joint_error_map_drawing,
    progress_drawing,
)
from app.features.analysis.schemas import DashboardFigures, DashboardKind, FigureView
from app.features.analysis.tables import (
    contacts_table,
    joint_angles_table,
    phases_table,
    scores_table,
    sessions_table,
)
from app.features.participants.service import planned_slots
from app.features.studies.service import newest_version, protocol_of, study_by_key
from app.protocol import StudyProtocol

TITLE_PREFIX = {"people": "", "simulated": "Simulated: ", "test": "Test: "}
BLINDED_NOTE = "The study is blinded: measures of sessions that are still open are left out."


def build_dashboard(db: Session, study_key: str, kind: DashboardKind) -> DashboardFigures:
    """Every figure of a study's sessions of one kind; raises NotFound for an unknown study."""
    protocol = protocol_of(newest_version(db, study_by_key(db, study_key)))
    sessions = sessions_table(db, study_key, kind)
    prefix = TITLE_PREFIX[kind]
    note = BLINDED_NOTE if protocol.blinding.operator else ""
    drawings = _drawings(db, protocol, sessions, kind)
    return DashboardFigures(
        kind=kind,
        simulated=kind == "simulated",
        n_sessions=len(sessions),
        n_completed=int((sessions["status"] == "completed").sum()),
        avatar=sorted(set(sessions["avatar"])),
        figures=[_view(drawing.marked(prefix, note)) for drawing in drawings],
    )


def _drawings(
    db: Session, protocol: StudyProtocol, sessions: pd.DataFrame, kind: DashboardKind
) -> Iterator[Drawing]:
    key, blinded = protocol.key, protocol.blinding.operator
    visible = sessions[sessions["status"] == "completed"] if blinded else sessions
    chosen = set(visible["session_id"])
    scores, phases, contacts, errors = (
        _counting(table(db, key, kind), chosen)
        for table in (scores_table, phases_table, contacts_table, joint_angles_table)
    )
    yield from embodiment_drawings(scores)
    yield joint_error_drawing(errors)
    yield joint_error_map_drawing(errors)
    yield contacts_drawing(phases, contacts)
    yield completions_drawing(phases)
    yield progress_drawing(sessions, _orders(protocol), blinded=blinded)


def _counting(rows: pd.DataFrame, sessions: set[str]) -> pd.DataFrame:
    """The valid rows of these sessions."""
    return rows[rows["valid"] & rows["session_id"].isin(sessions)]


def _orders(protocol: StudyProtocol) -> list[str]:
    latencies = {condition.key: condition.latency_ms for condition in protocol.conditions}
    slots = planned_slots(protocol)
    return sorted({" ".join(f"{latencies[name]:g}" for name in order) for order, _ in slots})


def _view(drawing: Drawing) -> FigureView:
    return FigureView(
        key=drawing.key,
        title=drawing.title,
        caption=drawing.caption,
        figure=drawing.as_json(),
        empty=drawing.empty,
        n=drawing.n,
    )
