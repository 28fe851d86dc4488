"""Pairing devices over HTTP."""

from fastapi import APIRouter, Request, Response

from app.features.people.audit.service import record
from app.features.record.devices.schemas import NewPairing, PairedView, PairingView, PairRequest
from app.features.record.devices.service import new_code, pair, revoke
from app.lan.qr import qr_svg
from app.platform.access import session_by_id
from app.platform.cookies import set_cookie
from app.platform.dependencies import TABLET_COOKIE, Context, SignedIn, Writing

router = APIRouter(tags=["devices"])
TABLET_COOKIE_DAYS = 2


@router.post("/sessions/{session_id}/pairings", status_code=201)
def post_pairing(
    session_id: str, wish: NewPairing, request: Request, db: Writing, context: Context, _: SignedIn
) -> PairingView:
    """Show a new code for a device of this session; an older unused code stops working."""
    context.storage.require_storage()
    session = session_by_id(db, session_id)
    made = new_code(
        db,
        session_id=session.id,
        kind=wish.device,
        now=context.clock.utc_now(),
        minutes=context.settings.pairing_minutes,
    )
    reach = context.network.reach
    base = reach.for_devices(str(request.base_url))
    url = f"{base}/tablet?code={made.code}" if wish.device == "tablet" else base
    return PairingView(
        device=wish.device,
        code=made.code,
        url=url,
        qr_svg=qr_svg(url) if wish.device == "tablet" else None,
        help_url=reach.help_url,
        help_qr_svg=None if reach.help_url is None else qr_svg(reach.help_url),
        expires_at=made.expires_at,
    )


@router.post("/devices/pair")
def post_pair(
    request_body: PairRequest, request: Request, response: Response, db: Writing, context: Context
) -> PairedView:
    """Use a code up. Guessing is slowed down."""
    context.storage.require_storage()
    caller = request.client.host if request.client else "unknown"
    context.pairing_limiter.attempt(caller)
    paired = pair(db, code=request_body.code, name=request_body.name, now=context.clock.utc_now())
    context.pairing_limiter.succeed(caller)
    device = paired.device
    context.hub.publish_after_commit(db, device.session_id)
    record(
        db,
        actor=f"{device.kind}:{device.id}",
        action="device.paired",
        subject=f"session:{device.session_id}",
        details={"device": device.kind, "address": caller},
        now=device.paired_at,
    )
    if device.kind == "tablet":
        set_cookie(request, response, TABLET_COOKIE, paired.token, TABLET_COOKIE_DAYS * 86_400)
    return PairedView(
        device="tablet" if device.kind == "tablet" else "headset",
        session_id=device.session_id,
        token=paired.token if device.kind == "headset" else None,
    )


@router.delete("/sessions/{session_id}/devices/{device_id}", status_code=204)
def delete_device(
    session_id: str, device_id: str, db: Writing, context: Context, caller: SignedIn
) -> None:
    """Unpair a device: its token stops working at once."""
    now = context.clock.utc_now()
    revoke(db, session_id=session_id, device_id=device_id, now=now)
    subject = f"session:{session_id}"
    record(db, actor=caller.actor, action="device.unpaired", subject=subject, now=now)
    context.hub.publish_after_commit(db, session_id)
