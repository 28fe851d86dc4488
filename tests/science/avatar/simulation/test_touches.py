"""Tests of showing and hiding boxes, and of the surfaces that the avatar touches."""

import numpy as np
import pytest

from app.science.avatar.mjcf.hinge_table import SimulationError
from app.science.avatar.mjcf.scene import Scene, SceneBox
from app.science.avatar.simulation.simulation import PhysicsAvatar
from app.science.avatar.simulation.touches import SurfaceTouches
from app.science.rotations import identity
from app.science.skeleton import JOINT_INDEX
from tests.science.avatar.captured import RATE_HZ
from tests.science.avatar.simulated import avatar

WALL, MARK = "hand/1/panel", "foot/start"
SCENE = Scene(
    (
        SceneBox(WALL, (1.0, 1.4, 0.0), (0.05, 0.4, 0.4)),
        SceneBox(MARK, (0.0, 0.0, 0.0), (0.3, 0.01, 0.3), solid=False),
    )
)
MARGIN_M = 0.005


def standing() -> tuple[PhysicsAvatar, SurfaceTouches]:
    """Return a body in the T-pose, the right hand near the wall and both feet on the mark."""
    body = avatar(SCENE, fingers=True)
    return body, SurfaceTouches(body, (WALL, MARK), MARGIN_M)


def go(body: PhysicsAvatar, metres: float, speed_m_s: float = 0.5) -> None:
    """Move the hips to the right by this many metres."""
    start, begun_s = body.state().root_position_m, body.time_s
    count = max(1, round(abs(metres) / speed_m_s * RATE_HZ))
    for frame in range(1, count + 1):
        body.set_hips(start + np.array([metres * frame / count, 0.0, 0.0]), identity())
        body.step_to(begun_s + frame / RATE_HZ)


def touched(touches: SurfaceTouches, surface: int) -> set[str]:
    """Return the joints that touch a surface now."""
    now, near = touches.read()
    assert not (now & ~near).any()
    return {name for name, row in JOINT_INDEX.items() if now[surface, row]}


def test_a_hand_touches_the_wall_that_stops_it() -> None:
    """A finger at the wall counts as the hand touching it; before that nothing touches."""
    body, touches = standing()
    assert touched(touches, 0) == set()
    go(body, 0.1)
    assert touched(touches, 0) == {"RightHand"}


def test_a_hidden_wall_is_passed_through() -> None:
    """A hidden wall is not touched; a wall that is shown around a hand pushes the hand out."""
    body, touches = standing()
    body.boxes.show((MARK,))
    go(body, 0.1)
    assert touched(touches, 0) == set()
    body.boxes.show((WALL, MARK))
    go(body, 0.0)
    assert touched(touches, 0) == {"RightHand"}
    assert body.health.restored == 0


def test_feet_touch_the_floor_mark_they_stand_on() -> None:
    """Both feet touch the floor mark they stand on, and neither does a metre away."""
    body, touches = standing()
    go(body, 0.0)
    assert {"LeftFoot", "RightFoot"} <= touched(touches, 1) <= {
        "LeftFoot", "LeftToes", "RightFoot", "RightToes",
    }  # fmt: skip
    go(body, -1.0)
    assert touched(touches, 1) == set()


def test_a_touch_ends_beyond_the_release_margin() -> None:
    """Within the release margin a hand is near but not in contact; beyond it the touch ends."""
    body, touches = standing()
    go(body, 0.1)
    hand = JOINT_INDEX["RightHand"]
    seen = []
    for _ in range(400):
        now, near = touches.read()
        seen.append((bool(now[0, hand]), bool(near[0, hand])))
        go(body, -0.0005, speed_m_s=0.045)
    assert seen[0] == (True, True)
    assert (False, True) in seen
    assert seen[-1] == (False, False)
    assert (False, True) not in seen[seen.index((False, False)) :]


def test_an_unknown_box_cannot_be_shown() -> None:
    """Showing an unknown box raises an error that names the existing ones."""
    body, _ = standing()
    with pytest.raises(SimulationError, match=f"no 'hand/9/panel': name one of {WALL}, {MARK}"):
        body.boxes.show(("hand/9/panel",))
