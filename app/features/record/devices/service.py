"""Pair devices: a short single-use code gives a device a token for one session only."""

import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from app.errors import Gone, NotFound
from app.models import Device, PairingCode
from app.platform.tokens import hash_token

# No vowels (so no words), and no 0/O, 1/I/L, 2/Z, 5/S, 8/B: unambiguous when read aloud or typed.
CODE_ALPHABET = "3467CDFGHJKMNPQRTVWXY9"
CODE_LENGTH = 6
TABLET_SILENT_AFTER_S = 30.0
"""A tablet receives a heartbeat every 10 s; after missing three it counts as disconnected."""


@dataclass(frozen=True)
class NewCode:
    """A new pairing code in plain text; only its hash is stored."""

    code: str
    kind: str
    expires_at: datetime


@dataclass(frozen=True)
class Paired:
    """A newly paired device with its token, which is available in plain text only here."""

    device: Device
    token: str


def new_code(db: Session, *, session_id: str, kind: str, now: datetime, minutes: float) -> NewCode:
    """Create a single-use code for pairing a tablet or headset; older codes stop working."""
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
    """Return the pairing code; raises NotFound if it is unknown, and Gone if used or expired."""
    plain = "".join(ch for ch in code.upper() if ch.isalnum())
    query = select(PairingCode).where(PairingCode.code_hash == hash_token(plain))
    row = db.scalar(query.with_for_update() if lock else query)
    if row is None:
        raise NotFound(
            "no session has this pairing code",
            value=code,
            remedy="Compare it with the code on the experimenter's screen, and enter it again.",
        )
    if row.used_at is not None or row.expires_at <= now:
        raise Gone(
            "this code was already used or has expired",
            value=code,
            remedy="Ask the experimenter to show a new code; devices that are paired keep working.",
        )
    return row


def pair(db: Session, *, code: str, name: str, now: datetime) -> Paired:
    """Pair a device by its code, replacing a paired device of the same kind.

    Raises NotFound for an unknown code, and Gone for one that was used or has expired.
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
    """Return the devices that are currently paired with a session."""
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
