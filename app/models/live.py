"""The tables of live tracking: which doors are open, and which tracker is on which limb."""

from sqlalchemy import String
from sqlalchemy.orm import Mapped, mapped_column

from app.database import Base
from app.models.types import UtcTime


class LiveDoor(Base):
    """The settings of a door for tracking data; a door without a row is closed.

    `interface` is the address of this machine on which packets are taken. `server` is the address
    of Motive, for NatNet only; `port` is then its port for requests.
    """

    __tablename__ = "live_doors"

    door: Mapped[str] = mapped_column(String(20), primary_key=True)
    is_open: Mapped[bool]
    interface: Mapped[str] = mapped_column(String(45))
    port: Mapped[int]
    server: Mapped[str | None] = mapped_column(String(45))
    multicast: Mapped[bool]
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]


class LiveLimb(Base):
    """The limb on which a tracker is worn; a tracker without a row is on none."""

    __tablename__ = "live_limbs"

    door: Mapped[str] = mapped_column(String(20), primary_key=True)
    source: Mapped[str] = mapped_column(String(64), primary_key=True)
    tracker: Mapped[str] = mapped_column(String(64), primary_key=True)
    limb: Mapped[str] = mapped_column(String(40))
    by: Mapped[str] = mapped_column(String(100))
    at: Mapped[UtcTime]
