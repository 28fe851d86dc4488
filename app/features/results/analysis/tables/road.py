"""The table of how participants crossed the study's road, and the records of its runs."""

from collections.abc import Iterator

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import study_by_key
from app.features.record.road import record_of
from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.context import finished, of_kind, phases_context, read
from app.models import RoadCrossing, RoadRun, StudySession

_KEYS = ("session_id", "phase_id")
_OWN = (
    *("number", "steps_on_s", "steps_off_s", "is_across", "waited_s", "gap_accepted_s"),
    *("gaps_refused_s", "least_time_to_collision_s", "least_post_encroachment_s", "closest_m"),
    *("collision_car", "collision_s", "collision_speed_m_s"),
)
_OF_RUN = {
    "run_part": RoadRun.part,
    "traffic_seed": RoadRun.seed,
    "run_ended": RoadRun.ended,
    "run_problem": RoadRun.reason,
    "run_guesses": RoadRun.guesses,
    "run_worst_guess_m": RoadRun.worst_guess_m,
    "record_sha256": RoadRun.sha256,
}


def road_crossings_table(db: Session, study_key: str, kind: Kind) -> pd.DataFrame:
    """Return one row per crossing of a phase, by session, phase, run and number."""
    query = (
        select(
            RoadCrossing.session_id,
            RoadCrossing.phase_id,
            *(getattr(RoadCrossing, name) for name in _OWN),
            *_OF_RUN.values(),
        )
        .join(RoadRun, RoadRun.id == RoadCrossing.run_id)
        .join(StudySession, StudySession.id == RoadCrossing.session_id)
        .where(of_kind(study_by_key(db, study_key), kind))
        .order_by(RoadRun.phase_id, RoadRun.part, RoadCrossing.number)
    )
    rows = read(db, query, (*_KEYS, *_OWN, *_OF_RUN))
    refused = rows["gaps_refused_s"]
    rows["refused"] = [len(one) for one in refused]
    rows["gaps_refused_s"] = [" ".join(f"{gap:g}" for gap in one) or None for one in refused]
    rows["collision"] = rows["collision_car"].notna()
    rows["run_problem"] = [one or None for one in rows["run_problem"]]
    context = phases_context(db, study_key, kind)
    return finished(context.merge(rows, on=list(_KEYS)), "road_crossings")


def road_records(db: Session, session_id: str) -> Iterator[tuple[int, int, bytes]]:
    """Yield phase, part and record of each run of a session's road, in their order."""
    runs = select(RoadRun).where(RoadRun.session_id == session_id)
    for run in db.scalars(runs.order_by(RoadRun.phase_id, RoadRun.part)):
        yield run.phase_id, run.part, record_of(db, run.id)
