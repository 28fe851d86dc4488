"""Endpoints for self-tests: what a headset needs for one, and the list for people."""

from fastapi import APIRouter, WebSocket

from app.features.record.headset import SessionAvatar, serve_headset, trial_avatar
from app.features.record.self_tests.schemas import SelfTestReport, SelfTestView
from app.features.record.self_tests.service import add_self_test, require_no_phase, self_tests
from app.features.record.self_tests.storage import StorageTrial
from app.platform.dependencies import Context, PairedHeadset, Reading, SignedIn, Writing

router = APIRouter(tags=["self-tests"])
STATURE_M = 1.75
"""The stature of the body that is simulated, of which nothing is recorded."""
MOST_LISTED = 200


@router.get("/vr/self-tests/avatar")
def get_self_test_avatar(db: Reading, headset: PairedHeadset) -> SessionAvatar:
    """Build the body to simulate in a self-test, of a person of 1.75 m; nothing is recorded.

    It is that of the headset's session, or the standard one if the session has no physics avatar.
    """
    require_no_phase(db, headset.session_id)
    return trial_avatar(db, headset.session_id, STATURE_M)


@router.websocket("/vr/self-tests/storage")
async def self_test_storage(socket: WebSocket) -> None:
    """Store and acknowledge the batches of a self-test, and keep none; see docs/protocol.md."""
    await serve_headset(socket, StorageTrial)


@router.post("/vr/self-tests", status_code=201)
def post_self_test(
    report: SelfTestReport, db: Writing, context: Context, _: PairedHeadset
) -> SelfTestView:
    """Store the report of a self-test and return the verdicts; sending it again changes nothing."""
    context.storage.require_storage()
    return add_self_test(db, report, now=context.clock.utc_now())


@router.get("/headset-tests")
def get_headset_tests(db: Reading, _: SignedIn) -> list[SelfTestView]:
    """Return the 200 self-tests of the lab's headsets that arrived last, the last one first."""
    return self_tests(db, most=MOST_LISTED)
