"""The doors and their settings, which the lab's database keeps."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from ipaddress import IPv4Address, IPv4Interface, IPv4Network

import psutil
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.adapters.live import COMMAND_PORT, DATA_PORT
from app.errors import InvalidInput
from app.features.movement.live.sources import DoorKey
from app.models import LiveDoor

LOOPBACK = "127.0.0.1"
USUAL_PORTS: dict[DoorKey, int] = {"osc": 39539, "natnet": COMMAND_PORT, "json": 39570}
"""The ports that are proposed: of VMC's receivers, of Motive's requests, and one of our own."""
_SERVER = "the IPv4 address of one computer, such as 192.168.1.20"
_ENTER = "Enter the local interface that Motive's streaming pane shows."
_THIS_NETWORK = IPv4Network("0.0.0.0/8")


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
    found = {one.ip for one in _addresses()}
    others = sorted(one for one in found if not one.is_loopback)
    return (LOOPBACK, *map(str, others))


def _addresses() -> Iterator[IPv4Interface]:
    """Yield this machine's IPv4 addresses, each with its network."""
    up = {name for name, state in psutil.net_if_stats().items() if state.isup}
    for name, group in psutil.net_if_addrs().items():
        if name in up:
            for one in group:
                if one.family.name == "AF_INET":
                    yield IPv4Interface(f"{one.address}/{one.netmask or 32}")


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
    if wish.is_open:
        _require_openable(wish, available)
        _require_free_port(db, wish)
    row = db.get(LiveDoor, wish.door) or LiveDoor(door=wish.door)
    row.is_open, row.interface, row.port = wish.is_open, wish.interface, wish.port
    row.server, row.multicast, row.by, row.at = wish.server, wish.multicast, by, now
    db.add(row)
    db.flush()


def _require_openable(wish: DoorSettings, available: Sequence[str]) -> None:
    if wish.interface not in available:
        raise InvalidInput(
            "this machine does not have that address",
            value=wish.interface,
            valid=list(available),
            remedy="Choose one of this machine's addresses.",
        )
    if wish.door != "natnet":
        return
    if wish.server is None:
        raise InvalidInput(
            "the address of Motive's computer is missing", valid=_SERVER, remedy=_ENTER
        )
    if not _is_one_computer(IPv4Address(wish.server)):
        raise InvalidInput(
            f"{wish.server} is not the address of a computer",
            value=wish.server,
            valid=_SERVER,
            remedy=_ENTER,
        )


def _is_one_computer(address: IPv4Address) -> bool:
    """Return whether an address is neither of many computers nor of none."""
    networks = [one.network for one in _addresses() if one.network.prefixlen < 31]
    return not (
        address.is_multicast
        or address.is_reserved  # with 255.255.255.255
        or address in _THIS_NETWORK
        or any(address in (one.network_address, one.broadcast_address) for one in networks)
    )


def _require_free_port(db: Session, wish: DoorSettings) -> None:
    """Raise InvalidInput if an open door takes the port: after a restart, either might get it."""
    for other in stored_doors(db):
        if other.door == wish.door or not other.is_open:
            continue
        port = _bound_port(wish)
        everywhere = "natnet" in (wish.door, other.door)
        if port == _bound_port(other) and (everywhere or wish.interface == other.interface):
            raise InvalidInput(
                f"door {other.door} has this port",
                value=port,
                valid="another port, 1024 to 65535",
                remedy="Choose another port, or close that door first.",
            )


def _bound_port(settings: DoorSettings) -> int | None:
    """Return our port that a door needs; that of a multicast group is taken on all addresses."""
    if settings.door != "natnet":
        return settings.port
    return DATA_PORT if settings.multicast else None
