"""Show whom a session's participant sees, in the units of the lab's page."""

from dataclasses import asdict

import numpy as np
from sqlalchemy.orm import Session

from app.features.movement.live import SILENT_S
from app.features.movement.performers import BodyState, Performers, body_state, joint_map_of
from app.features.record.companion.schemas import (
    CompanionView,
    PerformerOnOffer,
    SessionCompanion,
)
from app.features.record.companion.service import Companions, name_of
from app.features.record.sessions import Companion, state_of
from app.models import StudySession
from app.platform.context import AppContext

_MS_PER_S = 1000.0


def session_companion(db: Session, context: AppContext, session: StudySession) -> SessionCompanion:
    """Return whom a session's participant is shown, and who could be."""
    chosen = state_of(session).companion
    performers = context.part(Performers)
    view = SessionCompanion(
        companion=None if chosen is None else CompanionView.model_validate(asdict(chosen)),
        choices=_choices(performers),
        body=None if chosen is None else _body(db, performers, chosen),
    )
    shown = context.part(Companions).of(session.id)
    if shown is None:
        return view
    latencies_s = list(shown.latencies_s)
    return view.model_copy(
        update={
            "headset": "away" if shown.wake is None else "seen" if shown.is_seen else "hidden",
            "latency_ms": _ms(latencies_s, 50.0),
            "latency_p95_ms": _ms(latencies_s, 95.0),
            "stored": shown.waiting.stored,
            "waiting_lost": shown.waiting.lost,
        }
    )


def _body(db: Session, performers: Performers, chosen: Companion) -> BodyState:
    performer, others = performers.used(name_of(chosen))
    agreed = None if performer is None else performer.agreed
    problems = () if agreed is None else joint_map_of(db, agreed.rig)[1]
    return body_state(performer, others, problems, performers.now_s())


def _choices(performers: Performers) -> list[PerformerOnOffer]:
    now_s = performers.now_s()
    names = dict.fromkeys(one.name for one in performers.all())
    used = [(name, performers.used(name)[0]) for name in names]
    return [
        PerformerOnOffer(**asdict(name), is_silent=now_s - one.last_s > SILENT_S)
        for name, one in used
        if one is not None
    ]


def _ms(latencies_s: list[float], percentile: float) -> float | None:
    return _MS_PER_S * float(np.percentile(latencies_s, percentile)) if latencies_s else None
