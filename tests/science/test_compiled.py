"""Tests that one function compiled in two ways is not mistaken for the other."""

import numpy as np

from app.science.avatar.configuration import limits_of
from app.science.avatar.targets import TargetAngles
from app.science.rotations import identity, q_multiply
from app.science.simulation import posture_kernels


def test_poses_round_as_plain_python_beside_fused_code() -> None:
    """Quaternion products of a pose equal plain Python's, though targets have fused ones."""
    TargetAngles(limits_of("anatomic")).follow(identity(22))
    pairs = np.random.default_rng(1).standard_normal((2000, 2, 4))
    for a, b in pairs:
        one, other = tuple(a.tolist()), tuple(b.tolist())
        assert posture_kernels.q_multiply(one, other) == q_multiply(one, other)
