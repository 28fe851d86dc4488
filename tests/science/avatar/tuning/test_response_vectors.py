"""The figures of steps and pushes are those of the vectors that the console's page reads, too."""

import json

import numpy as np
import pytest

from app.science.avatar.tuning.disturbance import returned_after_s
from app.science.avatar.tuning.step_response import step_figures
from tests.science.avatar.tuning.response_vectors import FILE

_VECTORS = json.loads(FILE.read_text())


def test_steps_have_the_figures_of_the_vectors() -> None:
    """Overshoot, rise, settling and steady error follow from the angles of every vector."""
    for case in _VECTORS["steps"]:
        angles = np.array(case["angles_rad"])
        found = step_figures(angles, case["start_rad"], case["target_rad"], case["step_s"])
        assert vars(found) == pytest.approx(case["figures"], abs=1e-9), case["name"]


def test_pushes_have_the_figures_of_the_vectors() -> None:
    """The peak is the greatest deflection, the return counts from the end of the push."""
    for case in _VECTORS["pushes"]:
        turned = np.array(case["deflection_rad"])
        found = {
            "peak_rad": float(turned.max()),
            "return_s": returned_after_s(turned, case["pushed_ticks"], 1.0 / case["tick_s"]),
        }
        assert found == pytest.approx(case["figures"], abs=1e-9), case["name"]
