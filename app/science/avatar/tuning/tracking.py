"""How well a body follows a real movement, axis by axis.

The movement is given frame by frame as a headset would, and the avatar's angles are compared with
the targets of the same frame, over all frames but those of the first half second, in which the body
takes up the movement. `track` has nothing around the body, which asks how its motors follow. On a
floor (`follow_capture` does both) a foot stands where the capture's did only as well as the capture
knew that, and what the floor holds up is not where it was asked to be.

Three errors are told of either:

- against the clamped target, of all samples: what the limits allow the body to do;
- the same of the samples in touch and of the free ones apart. A body that touches the floor or
  itself is where that puts it, and no gains would take it elsewhere. An axis counts as in touch
  while its part, or one that hangs on it, touches something, and `AFTERWARDS_S` longer;
- against the unclamped target: what the person did, with the share that the limits took away.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import degrees, nan
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES, AXIS_NAMES, PARENT_OF, PART_NAMES, Figure
from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import FLOOR_ONLY, Scene, avatar_model
from app.science.avatar.tuning.results import TuningError
from app.science.rotations import FloatArray
from app.science.skeleton import Movement

if TYPE_CHECKING:
    from app.science.avatar.simulation import Contact

AFTERWARDS_S: Final = 0.1
"""The slowest motors are back at their targets by then."""
NOTHING: Final = Scene(floor=False)
_BEGIN_S: Final = 0.5


@dataclass(frozen=True)
class Spread:
    """Absolute errors of so many samples; NaN where there are none.

    Attributes:
        mean_deg: their mean.
        p95_deg: 95 % of them are at most this.
        samples: an axis in a frame is one.
    """

    mean_deg: float
    p95_deg: float
    samples: int


@dataclass(frozen=True)
class Tracking:
    """Errors of one body on one movement.

    Attributes:
        rms_deg: driven axis -> rms of clamped target less angle.
        clamped: of all driven axes and frames against the clamped target.
        free, touching: the same of the samples without and with touch.
        unclamped: against what was asked for before clamping.
        clipped_share: of the samples whose target the limits changed.
        touches: who touched whom -> share of the frames, such as `RightToes, floor`; the most
            frequent one first.
        frames: that were compared.
    """

    rms_deg: Mapping[str, float]
    clamped: Spread
    free: Spread
    touching: Spread
    unclamped: Spread
    clipped_share: float
    touches: Mapping[str, float]
    frames: int

    @property
    def mean_deg(self) -> float:
        """Of all samples against the clamped target."""
        return self.clamped.mean_deg

    @property
    def p95_deg(self) -> float:
        """Of all samples against the clamped target."""
        return self.clamped.p95_deg


def track(
    configuration: Configuration,
    stature_m: float,
    movement: Movement,
    *,
    scene: Scene = NOTHING,
    figure: Figure | None = None,
) -> Tracking:
    """Let a body follow a movement without delay.

    Args:
        configuration: of the body; its target space counts.
        stature_m: of the body.
        movement: of a skeleton of that stature, longer than half a second, at the rate of a
            headset (`skeleton.resample`).
        scene: what is around it.
        figure: the model that the configuration names.

    Raises:
        TuningError: the movement is too short. BodyError: there is no such body.
    """
    from app.science.avatar.simulation import Follower, PhysicsAvatar
    from app.science.avatar.targets import TargetAngles

    rate_hz, positions_m, rotations = (
        movement.rate_hz,
        movement.root_positions_m,
        movement.rotations,
    )
    skipped = round(_BEGIN_S * rate_hz)
    count = movement.frame_count
    if count <= skipped + 1:
        raise TuningError(
            f"the movement has {count} frames; more than {skipped + 1} are needed at {rate_hz:g} Hz"
        )
    built = avatar_model(configuration, stature_m, figure=figure, scene=scene, longest_delay_s=0.0)
    avatar = PhysicsAvatar(built.mjcf)
    angles = TargetAngles(configuration.in_force, built.body.parts)
    follower = Follower(avatar, angles, target_space=configuration.target_space)
    follower.start(positions_m[0], rotations[0])
    record = _Record(count - 1)
    for frame in range(1, count):
        seen = follower.frame(frame / rate_hz, positions_m[frame], rotations[frame])
        record.add(
            seen.targets.angles_rad,
            seen.targets.wanted_rad,
            seen.state.angles_rad,
            avatar.contacts(),
        )
    return record.tracking(skipped, round(AFTERWARDS_S * rate_hz), avatar.axis_names)


@dataclass(frozen=True)
class Followed:
    """One movement, with nothing around the body and on a floor."""

    alone: Tracking
    on_floor: Tracking


def follow_capture(
    configuration: Configuration,
    stature_m: float,
    movement: Movement,
    *,
    figure: Figure | None = None,
) -> Followed:
    """`track` it twice; the same arguments and errors."""
    return Followed(
        track(configuration, stature_m, movement, figure=figure),
        track(configuration, stature_m, movement, scene=FLOOR_ONLY, figure=figure),
    )


class _Record:
    """Errors and touches, frame by frame."""

    def __init__(self, frames: int) -> None:
        self._clamped = np.empty((frames, len(AXIS_NAMES)))
        self._unclamped = np.empty_like(self._clamped)
        self._touching = np.zeros(self._clamped.shape, dtype=np.bool_)
        self._touches: list[frozenset[str]] = []

    def add(
        self,
        clamped_rad: FloatArray,
        wanted_rad: FloatArray,
        actual_rad: FloatArray,
        contacts: Iterable["Contact"],
    ) -> None:
        frame, pressing = len(self._touches), [one for one in contacts if one.force_n > 0.0]
        self._clamped[frame] = np.abs(clamped_rad - actual_rad)
        self._unclamped[frame] = np.abs(wanted_rad - actual_rad)
        for one in pressing:
            for part in (one.part, one.other):
                if part in _CARRIERS:
                    self._touching[frame] |= _CARRIERS[part]
        self._touches.append(frozenset(f"{one.part}, {one.other}" for one in pressing))

    def tracking(self, skipped: int, afterwards: int, names: tuple[str, ...]) -> Tracking:
        columns = [AXIS_NAMES.index(name) for name in names]
        clamped = self._clamped[skipped:, columns]
        unclamped = self._unclamped[skipped:, columns]
        touching = _lasting(self._touching[:, columns], afterwards)[skipped:]
        rms = np.degrees(np.sqrt(np.mean(clamped**2, axis=0)))
        return Tracking(
            rms_deg=MappingProxyType(dict(zip(names, rms.tolist(), strict=True))),
            clamped=_spread(clamped),
            free=_spread(clamped[~touching]),
            touching=_spread(clamped[touching]),
            unclamped=_spread(unclamped),
            clipped_share=float(np.mean(clamped != unclamped)),
            touches=MappingProxyType(_shares(self._touches[skipped:])),
            frames=clamped.shape[0],
        )


def _carriers(part: str) -> npt.NDArray[np.bool_]:
    """(91,) the axes between the hips and the end of a part."""
    chain: set[str | None] = set()
    above: str | None = part
    while above is not None:
        chain.add(above)
        above = PARENT_OF[above]
    return np.array([axis.part in chain for axis in AXES])


_CARRIERS: Final = {part: _carriers(part) for part in PART_NAMES}


def _lasting(touching: npt.NDArray[np.bool_], frames: int) -> npt.NDArray[np.bool_]:
    """The same, each touch this many frames longer."""
    longer = touching.copy()
    for late in range(1, frames + 1):
        longer[late:] |= touching[:-late]
    return longer


def _spread(errors_rad: FloatArray) -> Spread:
    if errors_rad.size == 0:
        return Spread(nan, nan, 0)
    mean, p95 = float(errors_rad.mean()), float(np.percentile(errors_rad, 95.0))
    return Spread(degrees(mean), degrees(p95), errors_rad.size)


def _shares(touches: list[frozenset[str]]) -> dict[str, float]:
    counts: dict[str, int] = {}
    for frame in touches:
        for touch in frame:
            counts[touch] = counts.get(touch, 0) + 1
    ordered = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    return {touch: count / len(touches) for touch, count in ordered}
