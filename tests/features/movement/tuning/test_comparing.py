"""Tests of a comparison of gains on captures that are stored in the lab."""

from pathlib import Path

import pytest

from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.captures.files import uploaded, walk_bvh
from tests.features.movement.tuning.tunings import ARM, PATH, begun, settled

pytestmark = pytest.mark.one_engine

ELBOW = "LeftLowerArmY"
FREE = 8


@pytest.fixture(scope="module")
def tuned(lab: Lab) -> Json:
    """Return a finished tuning of the left elbow."""
    return settled(lab, begun(lab, axes=[ELBOW])["id"])


def compared(lab: Lab, tuning: Json, capture: Json, *accepted: str) -> Json:
    """Compare on a stored capture with these axes accepted."""
    request = {"accepted": accepted, "capture_id": capture["id"], "longest_s": 1.5}
    view: Json = ok(lab.operator.post(f"{PATH}/{tuning['id']}/comparison", json=request))
    return view


def test_a_stored_capture_shows_error_and_torque_by_axis(lab: Lab, tuned: Json) -> None:
    """On a stored capture only the accepted axis differs, in its error and in its torque.

    Every driven axis has both figures, and its torque is within its limit.
    """
    walk = uploaded(lab.operator, walk_bvh())
    found = compared(lab, tuned, walk, ELBOW)
    assert (found["frames"], found["duration_s"]) == (135, pytest.approx(1.5, abs=0.02))
    for figure in ("rms_error_deg", "rms_torque_nm"):
        before, after = found["before"][figure], found["after"][figure]
        assert len(before) == len(after) == FREE
        assert before[ELBOW] != after[ELBOW], figure
    for name, torque_nm in found["after"]["rms_torque_nm"].items():
        assert 0.0 <= torque_nm <= ARM.axes[name].max_torque_nm
    # An arm that hangs needs hardly any torque, but gravity wants some somewhere.
    assert max(found["after"]["rms_torque_nm"].values()) > 0.1
    same = compared(lab, tuned, walk)
    assert same["before"] == same["after"] == found["before"]


def test_a_capture_that_does_not_fit_is_refused_with_the_reason(
    lab: Lab, tuned: Json, shared_data: Path
) -> None:
    """Too short a capture, one without a skeleton, and one with an unusable map are refused."""

    def refusal(capture: Json, status: int, code: str) -> Json:
        request = {"accepted": [ELBOW], "capture_id": capture["id"]}
        path = f"{PATH}/{tuned['id']}/comparison"
        refused: Json = error(lab.operator.post(path, json=request), status, code)
        assert refused["remedy"]
        return refused

    short = refusal(uploaded(lab.operator, walk_bvh(15), "short.bvh"), 422, "invalid_input")
    assert (short["value"], short["valid"]) == ("0.47 s", "1 s or longer")
    assert "first half second" in short["message"]
    file = shared_data / "motion" / "optitrack_csv" / "sample_optitrack_take.csv"
    boxes = uploaded(lab.operator, file.read_bytes(), file.name)
    told = refusal(boxes, 409, "conflict")
    assert boxes["summary"]["no_skeleton"] in told["message"]
    strange = walk_bvh().replace(b"Spine", b"Rod").replace(b"UpLeg", b"Beam")
    strange = strange.replace(b"Leg", b"Bar").replace(b"Foot", b"Pad").replace(b"Hips", b"Box")
    unmapped = uploaded(lab.operator, strange, "strange.bvh")
    assert not ok(lab.operator.get(f"/api/captures/{unmapped['id']}/joint-map"))["usable"]
    told = refusal(unmapped, 409, "conflict")
    assert "joint map" in told["message"]
    assert told["details"]
