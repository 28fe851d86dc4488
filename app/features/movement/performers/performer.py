"""One performer: somebody whose skeleton a source sends, and the poses that are agreed with them.

Two things cannot be known from packets and are told by people: when the performer stands on the
floor, and, where a skeleton at rest is not in a T-pose, when they stand in one.
"""

from collections import deque
from dataclasses import dataclass, replace
from typing import Literal

from app.adapters.live import SkeletonDefinition
from app.features.movement.live import DoorKey, Sample
from app.features.movement.performers.assembly import Assembly, BodyFrame, Skeleton
from app.science.rig import Rig

AgreedPose = Literal["standing", "t_pose", "as_sent"]
"""`standing`: on the floor now. `t_pose`: in a T-pose on the floor now. `as_sent`: the source's own
rest pose is the T-pose, as at first."""
RATE_S = 2.0
_KEPT = 1024


@dataclass(frozen=True, slots=True)
class PerformerName:
    """How people name a performer: the door, the source's name, and the skeleton's, or empty."""

    door: DoorKey
    source: str
    skeleton: str


@dataclass(frozen=True, eq=False, slots=True)
class Agreed:
    """A skeleton with what was agreed about it; replaced as a whole.

    Attributes:
        skeleton: as it is sent.
        rig: the same bones, with the rotations of the T-pose as those at rest.
        standing: a frame in which the performer stands on the floor.
        is_t_pose_shown: whether the T-pose was shown by the performer.
    """

    skeleton: Skeleton
    rig: Rig
    standing: BodyFrame
    is_t_pose_shown: bool = False


class Performer:
    """A skeleton of a source. Not for several threads at once, but for its attributes.

    Attributes:
        name, address: who it is, and the sender's address.
        newest: the newest frame; None until every bone was seen.
        agreed: None as long as `newest` is.
        last_s: when the last packet with one of its bones arrived.
    """

    def __init__(self, name: PerformerName, address: str) -> None:
        self.name, self.address = name, address
        self.newest: BodyFrame | None = None
        self.agreed: Agreed | None = None
        self.last_s = float("-inf")
        self._assembly = Assembly()
        self._arrivals_s: deque[float] = deque(maxlen=_KEPT)

    @property
    def missing(self) -> tuple[str, ...]:
        """The bones that were not seen yet."""
        return self._assembly.missing if self.newest is None else ()

    @property
    def trackers(self) -> tuple[str, ...]:
        """The bones by the names that the source gives them, in the order of the rig."""
        return self._assembly.trackers

    def take(self, sample: Sample, definition: SkeletonDefinition | None) -> list[BodyFrame]:
        """Take a packet of the source; return the frames that are complete with it."""
        self.last_s = sample.arrival_s
        frames = self._assembly.take(sample, definition)
        for frame in frames:
            known = self.agreed
            if known is None or known.skeleton is not frame.skeleton:
                self.agreed = Agreed(frame.skeleton, frame.skeleton.rig, frame)
            elif not known.standing.observed.all() and frame.observed.all():
                # The first frame of all was not whole.
                self.agreed = replace(known, standing=frame)
            self.newest = frame
            self._arrivals_s.append(frame.arrival_s)
        return frames

    def agree(self, pose: AgreedPose) -> bool:
        """Take the present frame as the agreed pose; return False if there is none."""
        frame, known = self.newest, self.agreed
        if frame is None or known is None:
            return False
        if pose == "standing":
            self.agreed = replace(known, standing=frame)
        elif pose == "as_sent":
            self.agreed = Agreed(known.skeleton, known.skeleton.rig, known.standing)
        else:
            rig = replace(known.skeleton.rig, rest_rotations=frame.rotations)
            self.agreed = Agreed(known.skeleton, rig, frame, is_t_pose_shown=True)
        return True

    def rate_hz(self, now_s: float) -> float | None:
        """Return the frames per second of late; None if there are too few."""
        recent = [one for one in self._arrivals_s if one > now_s - RATE_S]
        if len(recent) < 2 or recent[-1] <= recent[0]:
            return None
        return (len(recent) - 1) / (recent[-1] - recent[0])
