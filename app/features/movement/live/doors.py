"""The doors and their settings, which the lab's database keeps."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from ipaddress import IPv4Address

import psutil
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.adapters.live import COMMAND_PORT
from app.errors import InvalidInput
from app.features.movement.live.sources import DoorKey
from app.models import LiveDoor

LOOPBACK = "127.0.0.1"
USUAL_PORTS: dict[DoorKey, int] = {"osc": 39539, "natnet": COMMAND_PORT, "json": 39570}
"""The ports that are proposed: of VMC's receivers, of Motive's requests, and one of our own."""


@dataclass(frozen=True)
class DoorSettings:
    """How a door is open or would be; `interface` and `server` are IPv4 addresses.

    `port` is our own, or for NatNet the server's. `multicast`: NatNet frames come to its group.
    `by` and `at`: who switched it last, and when; None if nobody ever did.
    """

    door: DoorKey
    is_open: bool = False
    interface: str = LOOPBACK
    port: int = 0
    server: str | None = None
    multicast: bool = False
    by: str | None = field(default=None, compare=False)
    at: datetime | None = field(default=None, compare=False)


def interfaces() -> tuple[str, ...]:
    """Return this machine's IPv4 addresses, the loopback first."""
    up = {name for name, state in psutil.net_if_stats().items() if state.isup}
    found = {
        IPv4Address(one.address)
        for name, group in psutil.net_if_addrs().items()
        if name in up
        for one in group
        if one.family.name == "AF_INET"
    }
    others = sorted(one for one in found if not one.is_loopback)
    return (LOOPBACK, *map(str, others))


def stored_doors(db: Session) -> tuple[DoorSettings, ...]:
    """Return the settings of every door; one that was never opened is closed."""
    rows = {row.door: row for row in db.scalars(select(LiveDoor))}
    return tuple(
        DoorSettings(key, port=port)
        if (row := rows.get(key)) is None
        else DoorSettings(
            key, row.is_open, row.interface, row.port, row.server, row.multicast, row.by, row.at
        )
        for key, port in USUAL_PORTS.items()
    )


def store_door(
    db: Session,
    wish: DoorSettings,
    *,
    available: Sequence[str],
    by: str,
    now: datetime,
) -> None:
    """Store the settings of a door; raises InvalidInput if it cannot be opened like that."""
    if wish.is_open and wish.interface not in available:
        raise InvalidInput(
            "this machine does not have that address",
            value=wish.interface,
            valid=list(available),
            remedy="Choose one of this machine's addresses.",
        )
    if wish.is_open and wish.door == "natnet" and wish.server is None:
        raise InvalidInput(
            "the address of Motive's computer is missing",
            valid="an IPv4 address, such as 192.168.1.20",
            remedy="Enter the local interface that Motive's streaming pane shows.",
        )
    row = db.get(LiveDoor, wish.door) or LiveDoor(door=wish.door)
    row.is_open, row.interface, row.port = wish.is_open, wish.interface, wish.port
    row.server, row.multicast, row.by, row.at = wish.server, wish.multicast, by, now
    db.add(row)
    db.flush()
