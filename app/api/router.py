"""Define all routes of the application in one place."""

from datetime import datetime
from functools import lru_cache
from typing import Any, Literal

from fastapi import APIRouter, FastAPI
from pydantic import BaseModel
from sqlalchemy import text
from starlette.routing import BaseRoute

from app import __version__
from app.features.care.network.endpoints import router as network
from app.features.care.rights.endpoints import router as rights
from app.features.care.storage.endpoints import router as storage
from app.features.design.instruments.endpoints import router as instruments
from app.features.design.studies.endpoints import router as studies
from app.features.movement.avatar.endpoints import router as avatars
from app.features.movement.captures.avatar_endpoints import router as on_avatars
from app.features.movement.captures.endpoints import router as captures
from app.features.movement.humanoids.endpoints import router as humanoids
from app.features.movement.live.endpoints import router as trackers
from app.features.movement.performers.endpoints import router as performers
from app.features.movement.tuning.endpoints import router as tunings
from app.features.movement.walking.endpoints import router as walks
from app.features.movement.walking.models.endpoints import router as walking_models
from app.features.people.accounts.endpoints import router as accounts
from app.features.people.accounts.people_endpoints import router as people
from app.features.people.audit.endpoints import router as audit
from app.features.record.alarms.endpoints import router as alarms
from app.features.record.calibrations.endpoints import router as calibrations
from app.features.record.cockpit import router as watching
from app.features.record.cockpit.endpoints import router as sessions
from app.features.record.companion.endpoints import router as companion
from app.features.record.demo.endpoints import router as demo
from app.features.record.devices.endpoints import router as devices
from app.features.record.headset.endpoints import router as headset
from app.features.record.headset.form_endpoints import router as headset_forms
from app.features.record.lab_state.endpoints import router as lab_state
from app.features.record.lab_trackers.endpoints import router as lab_trackers
from app.features.record.ledger.endpoints import router as participants
from app.features.record.poses.endpoints import router as poses
from app.features.record.preflight.endpoints import router as preflight
from app.features.record.receipts.endpoints import router as receipts
from app.features.record.road.endpoints import router as road
from app.features.record.self_tests.endpoints import router as self_tests
from app.features.record.suggestions.endpoints import router as suggestions
from app.features.record.tablet.endpoints import calls
from app.features.record.tablet.endpoints import direct as direct_to_tablets
from app.features.record.tablet.endpoints import first_answer as first_answer_to_tablet
from app.features.record.tablet.endpoints import router as tablet
from app.features.record.tryout.endpoints import router as tryout
from app.features.results.analysis.endpoints import router as analysis
from app.features.results.exports.endpoints import router as exports
from app.features.results.imports.endpoints import router as imports
from app.features.results.pilot.endpoints import router as pilots
from app.features.results.preregistration.endpoints import router as preregistrations
from app.features.results.replay.endpoints import router as replays
from app.platform.background import Failing
from app.platform.dependencies import API_PREFIX, Context


class Health(BaseModel):
    """The server's health: whether its database responds and the record can be written.

    `status` is degraded while something in the background fails, as listed in `failing`; failures
    of storage are reported only in `storage`. `low_disk`: little space is left in the data folder.
    """

    status: Literal["ok", "degraded"]
    version: str
    database: str
    storage: Literal["ok", "failing"]
    storage_since: datetime | None
    storage_reason: str | None
    low_disk: bool
    failing: tuple[Failing, ...]


class Refusal(BaseModel):
    """The reason for an error (app.errors): what happened, the value, what is valid, what to do.

    `details` lists the individual problems of a file or form, each with its place.
    """

    code: str
    message: str
    value: Any
    valid: Any
    remedy: str
    details: list[dict[str, Any]]


class ErrorBody(BaseModel):
    """The body of every error response."""

    error: Refusal


_ERROR_CONTENT = {"application/json": {"schema": {"$ref": "#/components/schemas/ErrorBody"}}}
REFUSALS: dict[int | str, dict[str, Any]] = {
    "4XX": {"description": "Refused, with the reason and the remedy.", "content": _ERROR_CONTENT},
    "503": {
        "description": "Cannot be stored now; nothing was stored.",
        "content": _ERROR_CONTENT,
    },
}
"""The errors of every route, which refer to the schema of `ErrorBody`.

Naming the model here would build two validators for each of the routes at every start.
"""


FIRST_ANSWERS = {"/tablet": first_answer_to_tablet}
"""What the server writes into a page, by the page's address."""


def add_routes(app: FastAPI) -> None:
    """Add the routes under /api to an application.

    They belong to no application: the one that serves them is in a request's scope, so a process
    builds them once, however many applications it makes.
    """
    app.router.routes[:0] = direct_to_tablets
    app.router.routes.extend(_routes())


@lru_cache(maxsize=1)
def _routes() -> tuple[BaseRoute, ...]:
    """Build all routes once per process, since including a router rebuilds its routes."""
    parts = (
        # Matched in this order: the most frequent requests first.
        *(tablet, sessions, watching),
        *(accounts, people, audit, studies, instruments, participants),
        *(devices, calls, headset, headset_forms, alarms, suggestions, calibrations),
        *(self_tests, lab_trackers, companion, road),
        *(analysis, exports, receipts, rights, network, captures, on_avatars, avatars),
        *(
            humanoids,
            preflight,
            poses,
            replays,
            storage,
            tryout,
            demo,
            lab_state,
            imports,
            preregistrations,
            pilots,
        ),
        *(walks, walking_models, tunings, trackers, performers),
    )
    own = APIRouter()
    # The one route that names the model, so that the interface's description has its schema.
    described: dict[int | str, dict[str, Any]] = {"4XX": {**REFUSALS["4XX"], "model": ErrorBody}}
    own.add_api_route("/health", get_health, methods=["GET"], tags=["health"], responses=described)
    everything = APIRouter()
    for part in (*parts, own):
        everything.include_router(part, prefix=API_PREFIX, responses=REFUSALS)
    return tuple(everything.routes)


def get_health(context: Context) -> Health:
    """Report whether the server and its database respond."""
    with context.database.reading() as db:
        db.execute(text("SELECT 1"))
    storage, failing = context.storage.state(), context.background.failing()
    return Health(
        status="degraded" if failing else "ok",
        version=__version__,
        database=context.database.engine.dialect.name,
        storage=storage.status,
        storage_since=storage.since,
        storage_reason=storage.reason,
        low_disk=storage.low_disk,
        failing=failing,
    )
