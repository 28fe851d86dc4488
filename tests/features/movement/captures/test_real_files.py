"""Tests with real recordings: ASF/AMC pairs, markers and rigid bodies."""

from pathlib import Path

import numpy as np
import pytest

from tests.features.lab import Lab, ok
from tests.features.movement.captures.files import positions_of, uploaded

pytestmark = pytest.mark.one_engine


def test_an_amc_comes_with_its_asf(fresh_lab: Lab, shared_data: Path) -> None:
    """An AMC file and its ASF companion are both stored and downloaded unchanged."""
    folder = shared_data / "motion" / "cmu_asfamc"
    amc, asf = ((folder / name).read_bytes() for name in ("02_01.amc", "02.asf"))
    more = {"companion": "02.asf", "companion_bytes": len(asf)}
    view = uploaded(fresh_lab.operator, amc + asf, "02_01.amc", **more)
    assert (view["kind"], view["frames"], view["companion_name"]) == ("skeleton", 343, "02.asf")
    assert view["size_bytes"] == len(amc)
    path = f"/api/captures/{view['id']}"
    assert fresh_lab.operator.get(f"{path}/file").content == amc
    assert fresh_lab.operator.get(f"{path}/file?companion=true").content == asf
    reply = ok(fresh_lab.operator.get(f"{path}/verification?avatars=165cm"))
    assert reply["lifts_agree"] is True


def test_markers_are_shown_with_their_fitted_skeleton(fresh_lab: Lab, shared_data: Path) -> None:
    """A capture of markers has a fitted skeleton that moves with them."""
    c3d = (shared_data / "motion" / "cmu_c3d" / "02_01.c3d").read_bytes()
    view = uploaded(fresh_lab.operator, c3d, "02_01.c3d")
    skeleton = view["summary"]["skeleton"]
    assert (view["kind"], view["has_skeleton"], skeleton["origin"]) == ("markers", True, "fitted")
    assert 0.0 < skeleton["residual_m"] < 0.1
    path = f"/api/captures/{view['id']}/motion"
    markers, markers_m = positions_of(fresh_lab.operator.get(path).content)
    joints, joints_m = positions_of(fresh_lab.operator.get(f"{path}?shown=skeleton").content)
    assert (markers["kind"], joints["kind"]) == ("markers", "skeleton")
    assert joints["names"] == skeleton["joints"]
    middle_m = np.nanmean(markers_m[len(markers_m) // 2], axis=0)
    hips_m = joints_m[len(joints_m) // 2, 0]
    assert np.linalg.norm(middle_m - hips_m) < 0.5


def test_a_capture_without_a_skeleton_gives_the_reason(fresh_lab: Lab, shared_data: Path) -> None:
    """A capture without a skeleton has a preview, and its joint map is refused with the reason."""
    file = shared_data / "motion" / "optitrack_csv" / "sample_optitrack_take.csv"
    view = uploaded(fresh_lab.operator, file.read_bytes(), file.name)
    assert (view["kind"], view["has_skeleton"]) == ("bodies", False)
    why = view["summary"]["no_skeleton"]
    path = f"/api/captures/{view['id']}"
    header, _ = positions_of(fresh_lab.operator.get(f"{path}/motion").content)
    assert header["names"] == view["summary"]["names"]
    for rest in ("joint-map", "retargeted?avatar=165cm", "verification?avatars=165cm"):
        answer = fresh_lab.operator.get(f"{path}/{rest}")
        assert answer.status_code == 409, rest
        assert why in answer.json()["error"]["message"]
    answer = fresh_lab.operator.get(f"{path}/motion?shown=skeleton")
    assert answer.status_code == 422
