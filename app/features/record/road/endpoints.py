"""Endpoints of the study's road."""

from dataclasses import asdict
from typing import Annotated

from fastapi import APIRouter, Path, WebSocket
from fastapi.responses import Response
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.features.design.studies import protocol_of
from app.features.record.headset import serve_headset
from app.features.record.road.recording import record_of
from app.features.record.road.schemas import CrossingView, RoadNow, RoadRunView, SessionRoad
from app.features.record.road.service import Roads, missing_for
from app.features.record.road.socket import RoadSocket
from app.models import RoadCrossing, RoadRun, StudySession, StudyVersion
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn
from app.protocol import StudyRoad

router = APIRouter(tags=["road"])
RunId = Annotated[str, Path(pattern=r"^[0-9a-f]{32}$")]


@router.websocket("/vr/road")
async def vr_road(socket: WebSocket) -> None:
    """Bring the study's road to a headset; see docs/protocol.md."""
    await serve_headset(socket, RoadSocket)


@router.get("/sessions/{session_id}/road")
def get_session_road(session_id: str, db: Reading, context: Context, _: SignedIn) -> SessionRoad:
    """Return how a session's road goes, its runs, and how the participant crossed."""
    session = session_by_id(db, session_id)
    version = db.get_one(StudyVersion, session.study_version_id)
    return _session_road(db, context, session, protocol_of(version).road)


@router.get(
    "/sessions/{session_id}/road/{run_id}",
    response_class=Response,
    responses={200: {"content": {"application/jsonl": {}}, "description": "The run's record."}},
)
def get_road_record(session_id: str, run_id: RunId, db: Reading, _: SignedIn) -> Response:
    """Return the record of a run as JSON lines (docs/crossing.md)."""
    session = session_by_id(db, session_id)
    run = db.get(RoadRun, run_id)
    if run is None or run.session_id != session.id:
        raise NotFound("this session has no such run of the road", value=run_id)
    return Response(record_of(db, run_id), media_type="application/jsonl")


def _session_road(
    db: Session, context: AppContext, session: StudySession, road: StudyRoad | None
) -> SessionRoad:
    """Return a session's runs with their crossings, and how the newest scene goes."""
    state = context.part(Roads).state(session.id)
    crossings: dict[str, list[CrossingView]] = {}
    of_session = select(RoadCrossing).where(RoadCrossing.session_id == session.id)
    for one in db.scalars(of_session.order_by(RoadCrossing.run_id, RoadCrossing.number)):
        values = {name: getattr(one, name) for name in CrossingView.model_fields}
        crossings.setdefault(one.run_id, []).append(CrossingView(**values))
    own = RoadRunView.model_fields.keys() - {"crossings"}
    runs = db.scalars(
        select(RoadRun)
        .where(RoadRun.session_id == session.id)
        .order_by(RoadRun.phase_id, RoadRun.part)
    )
    return SessionRoad(
        has_road=road is not None,
        missing=missing_for(road),
        now=None if state is None else RoadNow(**asdict(state)),
        runs=[
            RoadRunView(
                **{name: getattr(run, name) for name in own},
                crossings=crossings.get(run.id, []),
            )
            for run in runs
        ],
    )
