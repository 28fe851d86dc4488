"""A device pairs once by a short code and then holds a token for its own session only."""

import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from app.errors import Gone, NotFound
from app.models import Device, PairingCode
from app.platform.tokens import hash_token

# No vowels (no words), no 0/O, 1/I/L, 2/Z, 5/S, 8/B: read aloud and typed without doubt.
CODE_ALPHABET = "3467CDFGHJKMNPQRTVWXY9"
CODE_LENGTH = 6
TABLET_SILENT_AFTER_S = 30.0
"""A tablet is told every 10 s that the server is there; after three misses it counts as away."""


@dataclass(frozen=True)
class NewCode:
    """A code to show; it is stored as a hash."""

    code: str
    kind: str
    expires_at: datetime


@dataclass(frozen=True)
class Paired:
    """A device that has just been paired; the token leaves here once."""

    device: Device
    token: str


def new_code(db: Session, *, session_id: str, kind: str, now: datetime, minutes: float) -> NewCode:
    """Make a single-use code for a tablet or headset of a session; older ones stop working."""
    db.execute(
        update(PairingCode)
        .where(
            PairingCode.session_id == session_id,
            PairingCode.kind == kind,
            PairingCode.used_at.is_(None),
        )
        .values(used_at=now)
    )
    plain = "".join(secrets.choice(CODE_ALPHABET) for _ in range(CODE_LENGTH))
    expires_at = now + timedelta(minutes=minutes)
    db.add(
        PairingCode(
            code_hash=hash_token(plain),
            session_id=session_id,
            kind=kind,
            created_at=now,
            expires_at=expires_at,
        )
    )
    db.flush()
    return NewCode(f"{plain[:3]}-{plain[3:]}", kind, expires_at)


def usable_code(db: Session, code: str, now: datetime, *, lock: bool = False) -> PairingCode:
    """The code; raises NotFound for an unknown one and Gone for one that was used or is too old."""
    plain = "".join(ch for ch in code.upper() if ch.isalnum())
    query = select(PairingCode).where(PairingCode.code_hash == hash_token(plain))
    row = db.scalar(query.with_for_update() if lock else query)
    if row is None:
        raise NotFound(
            "no session waits for this code", value=code, remedy="Check the code on the console."
        )
    if row.used_at is not None or row.expires_at <= now:
        raise Gone(
            "this code was used already or is too old",
            value=code,
            remedy="Ask the experimenter to show a new code; the device paired first goes on.",
        )
    return row


def pair(db: Session, *, code: str, name: str, now: datetime) -> Paired:
    """Use a code up. A device of the same kind that was paired before is replaced.

    Raises NotFound for an unknown code and Gone for one that was used or is too old.
    """
    row = usable_code(db, code, now, lock=True)
    row.used_at = now
    db.execute(
        update(Device)
        .where(
            Device.session_id == row.session_id,
            Device.kind == row.kind,
            Device.revoked_at.is_(None),
        )
        .values(revoked_at=now)
    )
    token = secrets.token_urlsafe(32)
    device = Device(
        session_id=row.session_id,
        kind=row.kind,
        name=name[:80],
        token_hash=hash_token(token),
        paired_at=now,
        last_seen_at=now,
    )
    db.add(device)
    db.flush()
    return Paired(device, token)


def devices_of_session(db: Session, session_id: str) -> list[Device]:
    """The devices that are paired now."""
    query = (
        select(Device)
        .where(Device.session_id == session_id, Device.revoked_at.is_(None))
        .order_by(Device.paired_at)
    )
    return list(db.scalars(query))


def revoke(db: Session, *, session_id: str, device_id: str, now: datetime) -> None:
    """Unpair a device; raises NotFound if the session has no such device."""
    device = db.get(Device, device_id)
    if device is None or device.session_id != session_id:
        raise NotFound("no such device in this session", value=device_id)
    device.revoked_at = device.revoked_at or now
