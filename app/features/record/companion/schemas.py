"""Request and response models of a session's companion."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.features.movement.captures import AVATAR
from app.features.movement.live import DoorKey
from app.features.movement.performers import BodyState, PerformerWish
from app.features.record.companion.placing import Place

Stature = Annotated[str, StringConstraints(pattern=AVATAR)]
ContentHash = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]


class CompanionWish(PerformerWish):
    """Which performer is shown on which body, and where.

    `stature`: of the body, such as "165cm". `humanoid`: content hash of a body of the lab; null for
    a plain one. `in_tasks`: they are seen during tasks at the boxes, too.
    """

    stature: Stature
    humanoid: ContentHash | None
    place: Place
    in_tasks: bool = False


class CompanionChoice(BaseModel):
    """Who the participant is shown; null for nobody."""

    model_config = ConfigDict(extra="forbid")

    companion: CompanionWish | None


class CompanionView(CompanionWish):
    """Who the participant is shown, and where they stand: x and z in metres in the room."""

    position_m: tuple[float, float]
    heading_rad: float


class PerformerOnOffer(BaseModel):
    """A performer who could be shown."""

    door: DoorKey
    source: str
    skeleton: str
    is_silent: bool


class SessionCompanion(BaseModel):
    """The companion of a session.

    `body`: why their body moves or does not, null if nobody is chosen. `headset`: whether the
    participant sees them now. `latency_ms`, `latency_p95_ms`: from a packet's arrival to the
    headset's socket, null before the first one. `stored`: poses on disk since the server started,
    `waiting_lost`: those that were given up because the disk was full for minutes.
    """

    companion: CompanionView | None
    choices: list[PerformerOnOffer]
    body: BodyState | None = None
    headset: Literal["away", "hidden", "seen"] = "away"
    latency_ms: float | None = None
    latency_p95_ms: float | None = None
    stored: int = 0
    waiting_lost: int = 0
