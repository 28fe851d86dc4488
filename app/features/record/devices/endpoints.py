"""HTTP endpoints for pairing and unpairing devices."""

from datetime import datetime
from typing import Annotated, Literal

from fastapi import APIRouter, Request, Response
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints

from app.features.people.audit import record
from app.features.record.devices.service import new_code, pair, revoke, usable_code
from app.lan import qr_svg
from app.plain_titles import plain
from app.platform.access import session_by_id
from app.platform.admission import TABLET_COOKIE
from app.platform.dependencies import Context, SignedIn, Writing
from app.platform.rate_limit import network_of
from app.platform.tokens import set_cookie

DeviceKind = Literal["tablet", "headset"]


class NewPairing(BaseModel):
    """A request for a code to pair a device."""

    model_config = ConfigDict(extra="forbid")

    device: DeviceKind


class PairingView(BaseModel):
    """A single-use pairing code, valid until `expires_at`.

    `url` and `qr_svg` open the page of a tablet or a headset with the code; both are null if no
    other device can reach the server. `server_url` is the address of the server, for a headset's
    own program, into which the code is typed. `help_url` is the page from which a new device gets
    the lab's certificate; null if there is nothing to install.
    """

    device: DeviceKind
    code: str
    url: str | None
    qr_svg: str | None
    server_url: str | None
    help_url: str | None
    help_qr_svg: str | None
    expires_at: datetime


class PairRequest(BaseModel):
    """A pairing code, typed or scanned, and the name of the device."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(min_length=4, max_length=20, json_schema_extra={"writeOnly": True})
    name: Annotated[
        str, StringConstraints(strip_whitespace=True, max_length=80), AfterValidator(plain)
    ] = ""


class PairedView(BaseModel):
    """A device that was paired. Only headsets receive their token; a tablet has it in a cookie."""

    device: DeviceKind
    session_id: str
    token: str | None


router = APIRouter(tags=["devices"])
TABLET_COOKIE_DAYS = 2
PAGE_OF: dict[DeviceKind, str] = {"tablet": "/tablet", "headset": "/vr"}


@router.post("/sessions/{session_id}/pairings", status_code=201)
def post_pairing(
    session_id: str, body: NewPairing, request: Request, db: Writing, context: Context, _: SignedIn
) -> PairingView:
    """Create a code to pair a device with this session; an older unused code stops working."""
    context.storage.require_storage()
    session = session_by_id(db, session_id)
    made = new_code(
        db,
        session_id=session.id,
        kind=body.device,
        now=context.clock.utc_now(),
        minutes=context.settings.pairing_minutes,
    )
    reach = context.network.reach
    base = reach.for_devices(str(request.base_url))
    url = None if base is None else f"{base}{PAGE_OF[body.device]}?code={made.code}"
    return PairingView(
        device=body.device,
        code=made.code,
        url=url,
        qr_svg=None if url is None else qr_svg(url),
        server_url=base,
        help_url=reach.help_url,
        help_qr_svg=None if reach.help_url is None else qr_svg(reach.help_url),
        expires_at=made.expires_at,
    )


@router.post("/devices/pair")
def post_pair(
    request_body: PairRequest, request: Request, response: Response, context: Context
) -> PairedView:
    """Pair a device by its code, which can be used once.

    Attempts are rate-limited, and a wrong code never opens a write transaction.
    """
    context.storage.require_storage()
    address = request.client.host if request.client else "unknown"
    network, now = network_of(address), context.clock.utc_now()
    context.limits.codes.attempt(network)
    with context.database.reading() as db:
        usable_code(db, request_body.code, now)
    with context.database.writing() as db:
        paired = pair(db, code=request_body.code, name=request_body.name, now=now)
        device = paired.device
        context.hub.publish_after_commit(db, device.session_id)
        record(
            db,
            actor=f"{device.kind}:{device.id}",
            action="device.paired",
            subject=f"session:{device.session_id}",
            details={"device": device.kind, "address": address},
            now=device.paired_at,
        )
    context.limits.codes.take_back(network)
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
    """Unpair a device: its token stops working immediately."""
    now = context.clock.utc_now()
    revoke(db, session_id=session_id, device_id=device_id, now=now)
    subject = f"session:{session_id}"
    record(db, actor=caller.actor, action="device.unpaired", subject=subject, now=now)
    context.hub.publish_after_commit(db, session_id)
