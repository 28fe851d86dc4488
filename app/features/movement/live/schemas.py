"""Request and response models of live tracking."""

from datetime import datetime
from ipaddress import IPv4Address
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, field_validator

from app.features.movement.live.listening import DoorState, TroubleKind
from app.features.movement.live.sources import DoorKey

Name = Annotated[str, StringConstraints(min_length=1, max_length=64)]


class DoorWish(BaseModel):
    """How a door shall be.

    `interface`: the IPv4 address of this machine on which packets are taken. `port` is our own; for
    NatNet it is the port of Motive's requests, and `server` the address of Motive's computer.
    `multicast`: Motive sends its frames to the multicast group 239.255.42.99.
    """

    model_config = ConfigDict(extra="forbid")

    is_open: bool
    interface: Annotated[str, StringConstraints(max_length=45)] = "127.0.0.1"
    port: int = Field(strict=True, ge=1024, le=65535)
    server: Annotated[str, StringConstraints(max_length=45)] | None = None
    multicast: bool = False

    @field_validator("interface", "server")
    @classmethod
    def _an_address(cls, value: str | None) -> str | None:
        return value if value is None else str(IPv4Address(value.strip()))


class DoorView(BaseModel):
    """A door, its settings, and what came through it since it was opened.

    `state` is null while it is closed; `trouble` is the kind of the reason why it failed, and
    `trouble_detail` what the system says about it. `opened_by` at `opened_at`; `resumed`: the
    server opened it again when it was started. `foreign`: packets that are not from Motive's
    address. `unread`: packets that came faster than the door reads. `dropped`: packets that the
    kernel dropped; null where the system does not say.
    """

    door: DoorKey
    is_open: bool
    interface: str
    port: int
    server: str | None
    multicast: bool
    state: DoorState | None
    trouble: TroubleKind | None
    trouble_detail: str
    opened_by: str | None
    opened_at: datetime | None
    resumed: bool
    packets: int
    foreign: int
    unread: int
    dropped: int | None


class TrackerView(BaseModel):
    """A tracker or bone of a source; the figures are null until enough samples have arrived.

    `rate_hz` is over the last two seconds. `gaps` are intervals of more than three times the usual
    one; `jitter_ms`: 95 % of the other last intervals differ from the usual one by this at most.
    `tracked` is false if the source says that it lost the tracker.
    """

    name: str
    kind: Literal["tracker", "rigid_body", "bone", "root", "headset", "controller"]
    tracked: bool
    samples: int
    rate_hz: float | None
    gaps: int
    longest_gap_ms: float
    jitter_ms: float | None
    silent_s: float
    position_m: tuple[float, float, float] | None
    limb: str | None


class SourceView(BaseModel):
    """A sender at a door. `same_name`: another one that is not silent has the same name.

    `offset_s` maps the source's clock to the server's monotonic clock, with `uncertainty_ms`; both
    are null if the source sends no time, and the uncertainty for the first seconds. `doubled`,
    `late` and `skipped` packets are null if it sends neither time nor counter. `problems` counts by
    kind what could not be used.
    """

    door: DoorKey
    address: str
    name: str
    silent_s: float
    is_silent: bool
    same_name: bool
    packets: int
    doubled: int | None
    late: int | None
    skipped: int | None
    restarts: int
    offset_s: float | None
    uncertainty_ms: float | None
    problems: dict[str, int]
    trackers: list[TrackerView]


class LiveView(BaseModel):
    """All doors and sources. `turned_away`: packets of new senders, of which there were too many.

    `interfaces` are this machine's addresses, `limbs` the body's joints, in its order.
    """

    interfaces: list[str]
    limbs: list[str]
    doors: list[DoorView]
    sources: list[SourceView]
    turned_away: int


class LimbWish(BaseModel):
    """On which limb a tracker is worn; null for none. `source` is the name of its source."""

    model_config = ConfigDict(extra="forbid")

    door: DoorKey
    source: Name
    tracker: Name
    limb: str | None
