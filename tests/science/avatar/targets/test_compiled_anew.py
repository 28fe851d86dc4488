"""Tests that targets do not depend on when their code was compiled."""

import os
import subprocess
import sys
from pathlib import Path

FOLLOWED = """
import hashlib
import numpy as np
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.targets import TargetAngles

angles = TargetAngles(default_configuration().in_force)
still = np.zeros((22, 4))
still[:, 0] = 1.0
digest = hashlib.sha256()
for frame in range(100):
    turned = still + 0.2 * np.sin(0.05 * frame + np.arange(88).reshape(22, 4))
    targets = angles.follow(turned / np.linalg.norm(turned, axis=1)[:, np.newaxis])
    digest.update(targets.unclamped_rad.tobytes() + targets.residual_rad.tobytes())
print(digest.hexdigest())
"""


def test_a_process_that_compiles_gets_the_targets_of_one_that_loads(tmp_path: Path) -> None:
    """The first process, which compiles, and the next, which loads that code, agree to the bit.

    With multiplications and additions fused, they did not: what is fused depends on what else a
    function is compiled with. Contacts amplify a last digit, so a pilot differed between the first
    run on a machine and every later one.
    """
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    first, later = (
        subprocess.run(
            [sys.executable, "-c", FOLLOWED],
            env=environment, capture_output=True, text=True, check=True,
        ).stdout
        for _ in range(2)
    )  # fmt: skip
    assert list(tmp_path.rglob("hinge_angles*.nbi"))
    assert first == later
