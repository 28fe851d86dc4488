"""HTTP endpoints of live tracking."""

from anyio.to_thread import run_sync
from fastapi import APIRouter
from sqlalchemy.orm import Session

from app.features.movement.live.doors import DoorSettings, interfaces, store_door
from app.features.movement.live.schemas import DoorWish, LimbWish, LiveView
from app.features.movement.live.service import LiveTracking, store_limb
from app.features.movement.live.sources import DoorKey
from app.features.people.audit import record
from app.platform.dependencies import Context, Reading, SignedIn, Writing, write

router = APIRouter(prefix="/trackers", tags=["trackers"])


@router.get("")
def get_trackers(db: Reading, context: Context, _: SignedIn) -> LiveView:
    """Return the doors for tracking software, and every source that sends through them."""
    return context.part(LiveTracking).view(db)


@router.put("/doors/{door}")
async def put_door(door: DoorKey, body: DoorWish, context: Context, caller: SignedIn) -> LiveView:
    """Open or close a door, and store that for the next start of the server.

    A door that cannot be opened, because another program has its port, is tried again until it is
    closed.
    """
    wish = DoorSettings(door=door, **body.model_dump())

    def store(db: Session) -> None:
        now = context.clock.utc_now()
        store_door(db, wish, available=interfaces(), by=caller.actor, now=now)
        action = "tracker.opened" if wish.is_open else "tracker.closed"
        record(
            db,
            actor=caller.actor,
            action=action,
            subject=door,
            details={"door": door, **body.model_dump()},
            now=now,
        )

    def shown() -> LiveView:
        live = context.part(LiveTracking)
        live.follow(door)
        with context.database.reading() as db:
            return live.view(db)

    await write(context, store)
    return await run_sync(shown)


@router.put("/limbs")
def put_limb(body: LimbWish, db: Writing, context: Context, caller: SignedIn) -> LiveView:
    """Store on which limb a tracker is worn, for all sources of that name at this door."""
    store_limb(db, body, by=caller.actor, now=context.clock.utc_now())
    return context.part(LiveTracking).view(db)
