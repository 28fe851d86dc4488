"""Measure how well a body follows a recorded movement, axis by axis.

The movement is fed to the avatar frame by frame, as a headset would, and the avatar's angles are
compared with the targets of the same frame. The first half second, in which the body takes up the
movement, is left out. `track` uses an empty space, which shows how well the motors follow. With a
floor (`follow_capture` does both) a foot lands where the capture's foot did only as far as the
capture is accurate, and what the floor holds up cannot reach its target.

Either way, three kinds of error are reported:

- against the clamped target, over all samples: what the body does within its limits;
- the same separately for the samples in contact and without contact. A body in contact is where the
  floor or its own parts hold it, and no gains would move it elsewhere. An axis counts as in contact
  while its part, or a part attached to that, touches something, and for `CONTACT_HOLD_S` longer;
- against the unclamped target: what the person did, including the share that the limits cut off.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import degrees, nan
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES, AXIS_NAMES, PARENT_OF, PART_NAMES, Figure
from app.science.avatar.configuration import Configuration, world_limbs
from app.science.avatar.mjcf import FLOOR_ONLY, Scene, avatar_model
from app.science.avatar.tuning.results import TuningError
from app.science.rotations import FloatArray
from app.science.skeleton import Movement

if TYPE_CHECKING:
    from app.science.avatar.simulation import Contact

CONTACT_HOLD_S: Final = 0.1
"""How long after a contact an axis counts as in contact: the slowest motors are back at their
targets by then."""
EMPTY_SPACE: Final = Scene(floor=False)
_SKIPPED_S: Final = 0.5


@dataclass(frozen=True)
class Spread:
    """Mean and 95th percentile of a set of absolute errors; NaN for an empty set.

    Attributes:
        mean_deg: mean of the errors.
        p95_deg: 95th percentile of the errors.
        samples: number of errors; one axis in one frame is one sample.
    """

    mean_deg: float
    p95_deg: float
    samples: int


@dataclass(frozen=True)
class Tracking:
    """Errors of one body that follows one movement.

    Attributes:
        rms_deg: driven axis -> RMS of the clamped target minus the angle.
        rms_torque_nm: driven axis -> RMS of its motor's torque at the end of each frame, N m.
        clamped: errors of all driven axes and frames against the clamped target.
        free, touching: the same for the samples without and with contact.
        unclamped: errors against the target before clamping.
        clipped_share: share of the samples whose target the limits changed.
        saturated: axis -> share of the frames in which its motor is at its torque limit, for axes
            where it ever is.
        touches: pair in contact -> share of the frames, such as `RightToes, floor`; the most
            frequent one first.
        frames: number of frames that were compared.
    """

    rms_deg: Mapping[str, float]
    rms_torque_nm: Mapping[str, float]
    clamped: Spread
    free: Spread
    touching: Spread
    unclamped: Spread
    clipped_share: float
    saturated: Mapping[str, float]
    touches: Mapping[str, float]
    frames: int

    @property
    def mean_deg(self) -> float:
        """Return the mean error of all samples against the clamped target."""
        return self.clamped.mean_deg

    @property
    def p95_deg(self) -> float:
        """Return the 95th percentile of the errors of all samples against the clamped target."""
        return self.clamped.p95_deg


def track(
    configuration: Configuration,
    stature_m: float,
    movement: Movement,
    *,
    scene: Scene = EMPTY_SPACE,
    figure: Figure | None = None,
) -> Tracking:
    """Let a body follow a movement without delay and return its errors.

    Args:
        configuration: the configuration of the body; its target space is used.
        stature_m: the stature of the body.
        movement: the movement of a skeleton of that stature, longer than half a second, at the
            sampling rate of a headset (`skeleton.resample`).
        scene: the surroundings of the body.
        figure: the model that the configuration names.

    Raises:
        TuningError: the movement is too short.
        BodyError: the body cannot be built.
    """
    from app.science.avatar.simulation import Follower, PhysicsAvatar
    from app.science.avatar.targets import TargetAngles

    rate_hz, positions_m, rotations = (
        movement.rate_hz,
        movement.root_positions_m,
        movement.rotations,
    )
    skipped = round(_SKIPPED_S * rate_hz)
    count = movement.frame_count
    if count <= skipped + 1:
        raise TuningError(
            f"the movement has {count} frames; more than {skipped + 1} are needed at {rate_hz:g} Hz"
        )
    built = avatar_model(configuration, stature_m, figure=figure, scene=scene, longest_delay_s=0.0)
    avatar = PhysicsAvatar(built.mjcf)
    angles = TargetAngles(configuration.in_force, built.body.parts)
    follower = Follower(
        avatar,
        angles,
        target_space=configuration.target_space,
        world_limbs=world_limbs(configuration.compliance),
    )
    follower.start(positions_m[0], rotations[0])
    record = _Record(count - 1)
    for frame in range(1, count):
        result = follower.frame(frame / rate_hz, positions_m[frame], rotations[frame])
        record.add(
            result.targets.angles_rad,
            result.targets.unclamped_rad,
            result.state.angles_rad,
            avatar.contacts(),
            avatar.saturated(),
            avatar.torques_nm(),
        )
    return record.tracking(skipped, round(CONTACT_HOLD_S * rate_hz), avatar.axis_names)


@dataclass(frozen=True)
class Followed:
    """The errors for one movement, in an empty space and on a floor."""

    alone: Tracking
    on_floor: Tracking


def follow_capture(
    configuration: Configuration,
    stature_m: float,
    movement: Movement,
    *,
    figure: Figure | None = None,
) -> Followed:
    """Run `track` in an empty space and on a floor; it takes the same arguments.

    Raises:
        TuningError: the movement is too short.
        BodyError: the body cannot be built.
    """
    return Followed(
        track(configuration, stature_m, movement, figure=figure),
        track(configuration, stature_m, movement, scene=FLOOR_ONLY, figure=figure),
    )


class _Record:
    """Collects the errors and contacts of a movement frame by frame."""

    def __init__(self, frames: int) -> None:
        self._clamped = np.empty((frames, len(AXIS_NAMES)))
        self._unclamped = np.empty_like(self._clamped)
        self._touching = np.zeros(self._clamped.shape, dtype=np.bool_)
        self._touches: list[frozenset[str]] = []
        self._saturated: list[frozenset[str]] = []
        self._torques_nm: list[FloatArray] = []

    def add(
        self,
        clamped_rad: FloatArray,
        unclamped_rad: FloatArray,
        actual_rad: FloatArray,
        contacts: Iterable["Contact"],
        saturated: Iterable[str],
        torques_nm: FloatArray,
    ) -> None:
        frame, touching = (
            len(self._touches),
            [contact for contact in contacts if contact.force_n > 0.0],
        )
        self._clamped[frame] = np.abs(clamped_rad - actual_rad)
        self._unclamped[frame] = np.abs(unclamped_rad - actual_rad)
        for contact in touching:
            for part in (contact.part, contact.other):
                if part in _AXES_ABOVE:
                    self._touching[frame] |= _AXES_ABOVE[part]
        self._saturated.append(frozenset(saturated))
        self._torques_nm.append(torques_nm)
        self._touches.append(frozenset(f"{contact.part}, {contact.other}" for contact in touching))

    def tracking(self, skipped: int, hold_frames: int, names: tuple[str, ...]) -> Tracking:
        columns = [AXIS_NAMES.index(name) for name in names]
        clamped = self._clamped[skipped:, columns]
        unclamped = self._unclamped[skipped:, columns]
        touching = _extended(self._touching[:, columns], hold_frames)[skipped:]
        return Tracking(
            rms_deg=_by_axis(names, np.degrees(_rms(clamped))),
            rms_torque_nm=_by_axis(names, _rms(np.array(self._torques_nm)[skipped:])),
            clamped=_spread(clamped),
            free=_spread(clamped[~touching]),
            touching=_spread(clamped[touching]),
            unclamped=_spread(unclamped),
            clipped_share=float(np.mean(clamped != unclamped)),
            saturated=MappingProxyType(_shares(self._saturated[skipped:])),
            touches=MappingProxyType(_shares(self._touches[skipped:])),
            frames=clamped.shape[0],
        )


def _axes_above(part: str) -> npt.NDArray[np.bool_]:
    """Return whether each axis lies between the hips and the end of a part, (91,)."""
    chain: set[str | None] = set()
    above: str | None = part
    while above is not None:
        chain.add(above)
        above = PARENT_OF[above]
    return np.array([axis.part in chain for axis in AXES])


_AXES_ABOVE: Final = {part: _axes_above(part) for part in PART_NAMES}


def _extended(touching: npt.NDArray[np.bool_], frames: int) -> npt.NDArray[np.bool_]:
    """Return a copy in which each contact lasts this many frames longer."""
    longer = touching.copy()
    for delay in range(1, frames + 1):
        longer[delay:] |= touching[:-delay]
    return longer


def _rms(values: FloatArray) -> FloatArray:
    """Return the root mean square over the frames (frames, axes) of each axis, (axes,)."""
    rms: FloatArray = np.sqrt(np.mean(values**2, axis=0))
    return rms


def _by_axis(names: tuple[str, ...], values: FloatArray) -> Mapping[str, float]:
    return MappingProxyType(dict(zip(names, values.tolist(), strict=True)))


def _spread(errors_rad: FloatArray) -> Spread:
    if errors_rad.size == 0:
        return Spread(nan, nan, 0)
    mean, p95 = float(errors_rad.mean()), float(np.percentile(errors_rad, 95.0))
    return Spread(degrees(mean), degrees(p95), errors_rad.size)


def _shares(frames: list[frozenset[str]]) -> dict[str, float]:
    """Return name -> share of the frames that have it, the most frequent one first."""
    counts: dict[str, int] = {}
    for names in frames:
        for name in names:
            counts[name] = counts.get(name, 0) + 1
    ordered = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    return {name: count / len(frames) for name, count in ordered}
