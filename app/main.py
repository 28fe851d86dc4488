"""Assemble the application: from the settings to a complete FastAPI application."""

import asyncio
import logging
from collections.abc import AsyncIterator, Callable
from contextlib import ExitStack, asynccontextmanager, closing

from fastapi import FastAPI

from app import __version__
from app.api.errors import install_error_handler
from app.api.guards import Guards
from app.api.pages import install_pages
from app.api.router import FIRST_ANSWERS, add_routes
from app.clock import Clock
from app.database import open_database
from app.features.care.opening import bring_up_to_date
from app.features.care.ownership import Ownership, OwnerWatch, own_data
from app.features.care.rights import finish_erasures
from app.features.care.storage import StorageMeter, StorageRecovery
from app.features.design.studies import add_shipped
from app.features.movement.avatar import add_shipped_avatar
from app.features.movement.captures import CaptureQueue
from app.features.movement.humanoids import add_shipped_bodies
from app.features.movement.live import LiveTracking
from app.features.movement.performers import Performers
from app.features.movement.tuning import TuningDesk, TuningQueue
from app.features.movement.walking import FitQueue, PredictionQueue
from app.features.people.accounts import RefusedSignIns, ensure_admin
from app.features.record.companion import Companions
from app.features.record.demo import DemoRunner
from app.features.record.lab_trackers import LabTrackers
from app.features.record.road import Roads
from app.features.record.telemetry import Folder, Summariser, TelemetryWriter, stop_running_clocks
from app.features.record.tryout import TryoutRunner
from app.features.results.analysis import Drawings, FigurePreparation
from app.features.results.exports import ExportQueue
from app.features.results.pilot import PilotQueue
from app.features.results.replay import ReplayQueue
from app.lan import Network
from app.platform.admission import Admission
from app.platform.background import Background
from app.platform.context import AppContext, PartMaker
from app.platform.folders import database_file, home_of, protect
from app.platform.hub import Hub
from app.platform.incomplete_files import remove_leftovers
from app.platform.rate_limit import usual_limits
from app.platform.space_reserve import SpaceReserve
from app.platform.storage_health import StorageHealth
from app.resources import static_dir
from app.settings import Settings, read_settings

log = logging.getLogger(__name__)
PARTS: tuple[PartMaker, ...] = (
    StorageRecovery,
    Summariser,
    TelemetryWriter.of,
    Folder.of,
    Drawings.of,
    FigurePreparation.of,
    ReplayQueue.of,
    PilotQueue.of,
    lambda context: CaptureQueue().watched_by(context.background, "captures"),
    lambda context: PredictionQueue().watched_by(context.background, "walking"),
    FitQueue.of,
    lambda context: TuningDesk().watched_by(context.background, "tuning-curves"),
    TuningQueue.of,
    LiveTracking,
    Performers,
    LabTrackers,
    Companions,
    Roads,
    ExportQueue.of,
    StorageMeter.of,
    TryoutRunner.of,
    DemoRunner.of,
    RefusedSignIns.of,
)
"""The features' long-lived parts, started in this order and stopped in reverse."""


def create_app(
    settings: Settings | None = None,
    *,
    clock: Clock | None = None,
    network: Network | None = None,
    on_first_password: Callable[[str], None] | None = None,
    ownership: Ownership | None = None,
    on_taken_over: Callable[[], object] = lambda: None,
) -> FastAPI:
    """Create the application for `settings` (by default those of the environment).

    It is reachable over `network`. Start-up migrates the database, creates the first account
    (passing a random password to `on_first_password`), stores the shipped studies and pauses phases
    that a crash interrupted. Before that it takes ownership of the data, unless the caller already
    did and passes the `ownership`; `on_taken_over` is called if another process takes ownership
    later.
    """
    settings = settings or read_settings()
    clock, hub = clock or Clock(), Hub()
    # Space reserved on this machine does not help erasures in a database on another machine.
    embedded = None if database_file(settings) is None else home_of(settings)
    storage = StorageHealth(
        clock,
        settings.data_dir,
        settings.low_disk_bytes,
        hub.publish_storage,
        reserve=SpaceReserve(embedded),
    )
    database = open_database(settings.resolved_database_url, storage)
    context = AppContext(
        settings=settings,
        database=database,
        clock=clock,
        hub=hub,
        storage=storage,
        background=Background(clock, hub.publish_storage),
        limits=usual_limits(clock.monotonic_ns),
        admission=Admission(database, clock),
        network=network or Network(),
    )
    for make in PARTS:
        context.add(make(context))

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        with (
            ownership or own_data(context.settings) as own,
            closing(context.database),
            ExitStack() as stopping,
        ):
            try:
                context.background.watch_loop(asyncio.get_running_loop())
                _prepare(context, on_first_password)
                for part in (*context.parts, OwnerWatch(own, context.background, on_taken_over)):
                    part.start()
                    stopping.callback(part.stop)
            except Exception as error:
                # For the command that serves the application, which reports the reason.
                app.state.not_started = error
                raise
            yield

    app = FastAPI(
        title="Reembody",
        version=__version__,
        lifespan=lifespan,
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/openapi.json",
    )
    app.state.context = context
    install_error_handler(app)
    # Pages first: they are few, and need not wait for the routes of the interface, which are built
    # when a request is first compared with them.
    install_pages(app, static_dir(), FIRST_ANSWERS)
    add_routes(app)
    app.add_middleware(
        Guards,
        admission=context.admission,
        strangers=context.limits.strangers,
        max_body_bytes=settings.max_body_bytes,
        larger_bodies={
            ("POST", path): settings.max_capture_bytes
            for path in ("/api/captures", "/api/humanoids", "/api/walking/walk-sets/tracks")
        },
        host_names=lambda: (*settings.host_names, *context.network.reach.names),
    )
    return app


def _prepare(context: AppContext, on_first_password: Callable[[str], None] | None) -> None:
    for place in protect(context.settings):
        log.warning("others may read %s, and its mode cannot be changed", place)
    for one in remove_leftovers(context.settings, starting=True):
        log.warning("removed %s, a half-made %s of %s", one.path, one.kind, one.since.isoformat())
    backup = bring_up_to_date(context.settings, context.clock)
    if backup is not None:
        log.warning("the database was migrated; a backup from before is %s", backup)
    secret = context.settings.admin_password
    now = context.clock.utc_now()
    with context.database.writing() as db:
        made = ensure_admin(db, password=secret.get_secret_value() if secret else None, now=now)
        add_shipped_bodies(db, now)
        add_shipped_avatar(db, now)
        add_shipped(db, now)
    if made is not None and on_first_password is not None:
        on_first_password(made)
    finish_erasures(context)
    paused = stop_running_clocks(context)
    if paused:
        log.warning("%d running phase(s) were paused: the server had stopped in between", paused)
