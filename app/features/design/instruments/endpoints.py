"""HTTP endpoints of the instrument library: list, check files, store versions, score on trial."""

from itertools import groupby

from fastapi import APIRouter
from sqlalchemy import select

from app.errors import InvalidInput
from app.features.design.instruments.schemas import (
    InstrumentCheck,
    InstrumentDetail,
    InstrumentFile,
    InstrumentSummary,
    TryRequest,
    TryResult,
)
from app.features.design.instruments.service import (
    checked_instrument,
    instrument_of,
    save_instrument,
    taken_version,
    uses,
    versions_of_instrument,
)
from app.features.design.instruments.trial_scoring import try_answers
from app.features.design.instruments.views import detail_of, preview_of, summary_of
from app.models import InstrumentVersion
from app.platform.access import visible_to
from app.platform.config_problems import problem_views
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.protocol import ConfigError, load_instrument

router = APIRouter(tags=["instruments"])


@router.get("/instruments")
def get_instruments(db: Reading, caller: SignedIn) -> list[InstrumentSummary]:
    """Return the newest version of every instrument."""
    rows = db.scalars(
        select(InstrumentVersion).order_by(
            InstrumentVersion.key, InstrumentVersion.created_at, InstrumentVersion.id
        )
    )
    used = uses(db, visible_to(caller))
    by_key = groupby(rows, key=lambda row: row.key)
    return [summary_of(list(versions), used) for _, versions in by_key]


@router.post("/instruments", status_code=201)
def post_instrument(
    file: InstrumentFile, db: Writing, context: Context, caller: SignedIn
) -> InstrumentDetail:
    """Store an instrument version; existing studies keep the wording that they were made with."""
    row = save_instrument(db, file.yaml, context.clock.utc_now())
    return detail_of(db, row.key, visible_to(caller))


@router.post("/instruments/check")
def post_instrument_check(file: InstrumentFile, db: Reading, _: SignedIn) -> InstrumentCheck:
    """Check an instrument file without storing it."""
    try:
        loaded = load_instrument(file.yaml)
    except ConfigError as error:
        return InstrumentCheck(ok=False, problems=problem_views(error))
    taken = taken_version(db, loaded, file.yaml)
    if taken is not None:
        problems = problem_views(ConfigError((taken,)))
        return InstrumentCheck(
            ok=False,
            problems=problems,
            key=loaded.instrument.key,
            replaces=True,
            preview=preview_of(loaded.instrument),
        )
    key = loaded.instrument.key
    stored = db.scalars(
        select(InstrumentVersion.content_hash).where(InstrumentVersion.key == key)
    ).all()
    return InstrumentCheck(
        ok=True,
        key=key,
        content_hash=loaded.content_hash,
        known=loaded.content_hash in stored,
        replaces=any(one != loaded.content_hash for one in stored),
        preview=preview_of(loaded.instrument),
    )


@router.post("/instruments/score")
def post_score(request: TryRequest, db: Reading, _: SignedIn) -> TryResult:
    """Score answers without storing them, and return every step."""
    if (request.yaml is None) == (request.key is None):
        raise InvalidInput(
            "either a file or a key must name the instrument",
            valid="either yaml or key",
            remedy="Send the file's text as yaml, or the key of a stored instrument.",
        )
    if request.yaml is not None:
        instrument = checked_instrument(request.yaml).instrument
    else:
        instrument = instrument_of(versions_of_instrument(db, request.key or "")[-1])
    return try_answers(instrument, request.answers)


@router.get("/instruments/{key}")
def get_instrument(key: str, db: Reading, caller: SignedIn) -> InstrumentDetail:
    """Return one instrument in full, with all its versions."""
    return detail_of(db, key, visible_to(caller))
