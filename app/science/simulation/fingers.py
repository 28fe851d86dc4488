"""Generate finger movement for a simulated participant. It was not recorded from a person.

Each hand goes through gestures in random order: fist, pinch, thumb opposition, an open and a
relaxed hand. A gesture is a set of joint angles within the limits of a human hand, the same on both
sides; a hand takes 0.35 to 0.7 s to the next one along a minimum-jerk path (Flash and Hogan 1985),
and holds it for a while. A hand that reaches for something points with its index finger instead. A
tremor of about 9 Hz and a tenth of a degree lies on top, so that no finger is ever completely
still.

The angles, times and tremor are estimates: the movement serves to exercise storage, contacts and
statistics, and says nothing about people.
"""

from collections.abc import Mapping
from math import pi, radians
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.targets import finger_rotations
from app.science.rotations import FloatArray, slerp
from app.science.simulation.paths import minimum_jerk
from app.science.skeleton import FINGERS, PARTS_PER_HAND

Angles = npt.NDArray[np.float64]
_SIDES = ("Left", "Right")
_TREMOR_RAD = radians(0.15)
_TREMOR_HZ = 9.0
_MOVE_S, _HOLD_S = (0.35, 0.7), (0.3, 1.2)
_POINT_WITHIN_S = 0.25


def _finger(proximal: float, intermediate: float, distal: float) -> dict[str, float]:
    return {"ProximalZ": proximal, "IntermediateZ": intermediate, "DistalZ": distal}


def _thumb(across: float, lowered: float, middle: float, tip: float) -> dict[str, float]:
    return {
        "ThumbProximalY": across,
        "ThumbProximalZ": lowered,
        "ThumbIntermediateY": middle,
        "ThumbDistalY": tip,
    }


def _hand(thumb: dict[str, float], *fingers: dict[str, float]) -> dict[str, float]:
    named = zip(FINGERS[1:], fingers, strict=True)
    return thumb | {f"{name}{axis}": deg for name, own in named for axis, deg in own.items()}


_RELAXED = _finger(18.0, 28.0, 14.0)
_CLOSED = _finger(85.0, 95.0, 65.0)
_STRAIGHT = _finger(0.0, 2.0, 1.0)
GESTURES_DEG: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "relaxed": _hand(_thumb(10.0, 12.0, 10.0, 10.0), _RELAXED, _RELAXED, _RELAXED, _RELAXED),
        "open": _hand(_thumb(-10.0, 0.0, 0.0, -5.0), _STRAIGHT, _STRAIGHT, _STRAIGHT, _STRAIGHT),
        "fist": _hand(_thumb(40.0, 35.0, 45.0, 50.0), _CLOSED, _CLOSED, _CLOSED, _CLOSED),
        "pinch": _hand(
            _thumb(30.0, 40.0, 25.0, 20.0), _finger(48.0, 52.0, 22.0), _RELAXED, _RELAXED, _RELAXED
        ),
        "thumb opposition": _hand(
            _thumb(55.0, 42.0, 40.0, 45.0),
            _STRAIGHT,
            _finger(10.0, 12.0, 6.0),
            _finger(38.0, 36.0, 18.0),
            _finger(62.0, 55.0, 30.0),
        ),
        "point": _hand(_thumb(38.0, 30.0, 40.0, 40.0), _STRAIGHT, _CLOSED, _CLOSED, _CLOSED),
    }
)
"""The joint angles of each gesture, in degrees, by axis without the side; others are zero."""
_IN_TURN = tuple(name for name in GESTURES_DEG if name != "point")


def gesture_angles(gesture: str, side: str) -> Angles:
    """Return the angles (91,) of one hand in a gesture, in radians, in the order of `AXIS_NAMES`.

    Raises KeyError for an unknown gesture.
    """
    angles = np.zeros(len(AXIS_NAMES))
    for axis, deg in GESTURES_DEG[gesture].items():
        angles[AXIS_NAMES.index(f"{side}{axis}")] = radians(deg)
    return angles


class _Hand:
    """One hand on its way from gesture to gesture."""

    def __init__(self, side: str, rng: np.random.Generator) -> None:
        self._side, self._rng = side, rng
        self._from = self._to = gesture_angles("relaxed", side)
        self._gesture = "relaxed"
        self._begin_s, self._move_s, self._next_s = 0.0, 1.0, float(rng.uniform(*_HOLD_S))
        own = self._to != 0.0
        self._tremor_rad = np.where(own, _TREMOR_RAD, 0.0)
        self._phase_rad = rng.uniform(0.0, 2.0 * pi, len(own))
        self._pace_hz = rng.uniform(0.85, 1.15, len(own)) * _TREMOR_HZ

    def at(self, time_s: float, *, pointing: bool) -> Angles:
        if pointing != (self._gesture == "point"):
            self._go("point" if pointing else "relaxed", time_s, _POINT_WITHIN_S)
        elif not pointing and time_s >= self._next_s:
            others = [name for name in _IN_TURN if name != self._gesture]
            self._go(str(self._rng.choice(others)), time_s, float(self._rng.uniform(*_MOVE_S)))
        waves: Angles = np.sin(2.0 * pi * self._pace_hz * time_s + self._phase_rad)
        return self._place(time_s) + self._tremor_rad * waves

    def _go(self, gesture: str, time_s: float, move_s: float) -> None:
        self._from, self._to = self._place(time_s), gesture_angles(gesture, self._side)
        self._gesture, self._begin_s, self._move_s = gesture, time_s, move_s
        self._next_s = time_s + move_s + float(self._rng.uniform(*_HOLD_S))

    def _place(self, time_s: float) -> Angles:
        share = minimum_jerk(min(max((time_s - self._begin_s) / self._move_s, 0.0), 1.0))
        place: Angles = self._from + share * (self._to - self._from)
        return place


class SimulatedFingers:
    """The fingers of one simulated person. All randomness comes from `rng`."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._hands = tuple(_Hand(side, rng) for side in _SIDES)

    def pose(self, time_s: float, pointing: str | None = None) -> FloatArray:
        """Return the local rotations (30, 4) of the finger parts; call in order of time.

        `pointing`: the hand that reaches for something, "LeftHand" or "RightHand".
        """
        angles = sum(
            (
                hand.at(time_s, pointing=pointing == f"{side}Hand")
                for side, hand in zip(_SIDES, self._hands, strict=True)
            ),
            np.zeros(len(AXIS_NAMES)),
        )
        return finger_rotations(angles)


class LoopedFingers:
    """The fingers of a capture, played in a loop together with its body.

    A hand that reaches for something points with its index finger instead.

    Args:
        rotations: (N, 30, 4) local rotations of a loop.
        rate_hz: frames per second.
        offset_s: the place in the loop at time 0: that of the body.
    """

    def __init__(self, rotations: FloatArray, rate_hz: float, offset_s: float) -> None:
        self._rotations, self._rate_hz, self._offset_s = rotations, rate_hz, offset_s
        self._point = finger_rotations(
            gesture_angles("point", "Left") + gesture_angles("point", "Right")
        )
        self._share = np.zeros(len(_SIDES))
        self._time_s: float | None = None

    def pose(self, time_s: float, pointing: str | None = None) -> FloatArray:
        """Return the local rotations (30, 4) of the finger parts; call in order of time."""
        passed_s = 0.0 if self._time_s is None else time_s - self._time_s
        self._time_s = time_s
        goal = np.array([pointing == f"{side}Hand" for side in _SIDES], dtype=np.float64)
        most = passed_s / _POINT_WITHIN_S
        self._share += np.clip(goal - self._share, -most, most)
        frame = round((time_s + self._offset_s) * self._rate_hz) % len(self._rotations)
        share = np.repeat([minimum_jerk(float(one)) for one in self._share], PARTS_PER_HAND)
        return slerp(self._rotations[frame], self._point, share)
