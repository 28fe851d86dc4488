"""Tests of a capture on avatars: the paper's verification, previews and files."""

import csv

import numpy as np
import pytest

from app.adapters.bvh import parse_bvh
from app.adapters.captures.bvh_export import to_bvh
from app.adapters.captures.reader import read_capture
from app.science.anatomy import mirrored_skeleton
from app.science.retargeting import reference_avatar
from app.science.rig import RigMotion, to_world
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.captures.files import (
    LIFT_M,
    SPEED_M_S,
    positions_of,
    uploaded,
    walk_bvh,
)

pytestmark = pytest.mark.one_engine

AVATARS = "avatars=130cm&avatars=165cm&avatars=190cm"


@pytest.fixture(scope="module")
def walk(lab: Lab) -> Json:
    """Return an uploaded walk of five strides."""
    return uploaded(lab.operator, walk_bvh())


def test_a_walk_keeps_its_steps_on_every_avatar(lab: Lab, walk: Json) -> None:
    """A walk has the same foot lifts at the same times on every avatar, scaled to its legs."""
    reply = ok(lab.operator.get(f"/api/captures/{walk['id']}/verification?{AVATARS}"))
    assert (reply["frames"], reply["rate_hz"], reply["lock_feet"]) == (150, 30.0, False)
    assert len(reply["times_s"]) == 150
    source = reply["source"]
    assert len(source["strides"]) >= 7
    assert source["mean_stride_length_m"] == pytest.approx(SPEED_M_S, rel=0.02)
    assert source["mean_step_height_m"] == pytest.approx(LIFT_M, rel=0.05)
    assert [avatar["name"] for avatar in reply["avatars"]] == ["130cm", "165cm", "190cm"]
    assert reply["lifts_agree"] is True
    assert reply["largest_timing_difference_s"] <= 2 / 30
    for avatar in reply["avatars"]:
        assert avatar["lifts_agree"] is True
        assert avatar["stature_m"] == pytest.approx(float(avatar["name"][:-2]) / 100)
        assert avatar["length_ratio"] == pytest.approx(avatar["leg_ratio"], rel=0.05)
        assert (avatar["slide_before_m_s"], avatar["lowered_m"]) == (None, None)
        for path in avatar["toe_paths"]:
            assert len(path["forward_m"]) == len(path["height_m"]) == 150
    lengths = [avatar["mean_stride_length_m"] for avatar in reply["avatars"]]
    assert lengths == sorted(lengths)
    assert reply["unmapped_body_joints"] == ["UpperChest"]


def test_locked_feet_slide_less(lab: Lab, walk: Json) -> None:
    """Locking the feet does not increase their sliding, which is reported before and after."""
    address = f"/api/captures/{walk['id']}/verification?avatars=190cm&lock_feet=true"
    (avatar,) = ok(lab.operator.get(address))["avatars"]
    assert avatar["slide_m_s"] <= avatar["slide_before_m_s"]
    assert avatar["lowered_m"] >= 0.0


def test_a_mirrored_walk_is_mirrored_back_and_named(lab: Lab, walk: Json) -> None:
    """A walk in left-handed axes says so, and has the same steps on avatars, above the floor."""
    clip = read_capture(walk_bvh(), name="walk.bvh").motion
    assert isinstance(clip, RigMotion)
    there = uploaded(lab.operator, to_bvh(mirrored_skeleton(clip)).encode(), "mirrored.bvh")
    assert walk["summary"]["skeleton"]["notices"] == []
    (notice,) = there["summary"]["skeleton"]["notices"]
    assert (notice["rule"], notice["action"]) == ("mirrored", "mended")
    heights = []
    for capture in (walk, there):
        path = f"/api/captures/{capture['id']}/verification?avatars=165cm"
        (avatar,) = ok(lab.operator.get(path))["avatars"]
        assert avatar["notices"] == []
        assert avatar["floor"]["left_m"] <= 0.01
        heights.append(avatar["mean_step_height_m"])
    assert heights[0] == pytest.approx(heights[1], abs=1e-3)


def test_a_preview_on_an_avatar_has_its_size(lab: Lab, walk: Json) -> None:
    """A preview of a capture on an avatar stands on the ground and has the avatar's size."""
    path = f"/api/captures/{walk['id']}/retargeted-motion"
    heights = {}
    for avatar in ("130cm", "190cm"):
        header, positions_m = positions_of(lab.operator.get(f"{path}?avatar={avatar}").content)
        assert (header["kind"], header["frames"]) == ("skeleton", 150)
        assert np.isfinite(positions_m).all()
        heights[avatar] = float(positions_m[0, header["names"].index("Head"), 1])
        assert -0.01 < positions_m[0, :, 1].min() < 0.1
    assert heights["130cm"] / heights["190cm"] == pytest.approx(130 / 190, rel=0.02)


def test_rotations_follow_on_request(lab: Lab, walk: Json) -> None:
    """On request a preview has the joints' rotations, which lead to the same positions."""
    path = f"/api/captures/{walk['id']}/retargeted-motion?avatar=165cm"
    plain = lab.operator.get(path).content
    turned = lab.operator.get(f"{path}&rotations=true").content
    header, positions_m = positions_of(plain)
    count = header["frames"] * len(header["names"])
    local = np.frombuffer(turned[-16 * count :], "<f4").reshape(header["frames"], -1, 4)
    assert turned[-28 * count : -16 * count] == plain[-12 * count :]
    hips_m = positions_m[:, 0].astype(np.float64)
    moved_m, _ = to_world(reference_avatar(1.65), hips_m, local.astype(np.float64))
    np.testing.assert_allclose(moved_m, positions_m, atol=1e-5)


def test_an_avatars_movement_can_be_downloaded(lab: Lab, walk: Json) -> None:
    """An avatar's movement downloads as BVH and as CSV with the same positions."""
    path = f"/api/captures/{walk['id']}"
    preview = lab.operator.get(f"{path}/retargeted-motion?avatar=165cm")
    header, shown_m = positions_of(preview.content)
    kept = lab.operator.get(f"{path}/retargeted?avatar=165cm&format=bvh")
    assert "walk-165cm.bvh" in kept.headers["content-disposition"]
    clip = parse_bvh(kept.text, metres_per_unit=0.01)
    order = [clip.names.index(name) for name in header["names"]]
    np.testing.assert_allclose(clip.world()[0][:, order], shown_m, atol=1e-5)
    table = lab.operator.get(f"{path}/retargeted?avatar=165cm&format=csv")
    assert table.headers["content-type"].startswith("text/csv")
    columns, *rows = csv.reader(table.text.splitlines())
    assert len(rows) == 150
    head = [columns.index(f"Head.{axis}_m") for axis in "xyz"]
    told_m = np.array([[float(row[at]) for at in head] for row in rows])
    np.testing.assert_allclose(told_m, shown_m[:, header["names"].index("Head")], atol=1e-6)
    assert float(rows[30][columns.index("time_s")]) == pytest.approx(1.0)


def test_invalid_avatar_sizes_are_refused(lab: Lab, walk: Json) -> None:
    """Avatars that are not given as a possible stature in centimetres, or too many, are refused."""
    path = f"/api/captures/{walk['id']}"
    for avatar in ("165", "1.65m", "20cm", "999cm", "faye"):
        error(lab.operator.get(f"{path}/retargeted-motion?avatar={avatar}"), 422, "invalid_input")
    many = "&".join(f"avatars={120 + n}cm" for n in range(9))
    error(lab.operator.get(f"{path}/verification?{many}"), 422, "invalid_input")
    error(lab.operator.get(f"{path}/verification"), 422, "invalid_input")


@pytest.mark.one_engine
def test_a_generated_walk_needs_no_capture(fresh_lab: Lab) -> None:
    """The generated walk of eight steps keeps its lifts, and its strides grow with the leg."""
    found = ok(fresh_lab.operator.get(f"/api/captures/generated/verification?{AVATARS}"))
    assert found["lifts_agree"]
    # Of nine swings, the first and the last are half as long: (2 x 0.7 + 7 x 1.4) / 9.
    assert len(found["source"]["strides"]) == 9
    assert found["source"]["mean_stride_length_m"] == pytest.approx(1.2444, abs=1e-3)
    lengths = [one["mean_stride_length_m"] for one in found["avatars"]]
    assert lengths == sorted(lengths)
    for one, length in zip(found["avatars"], lengths, strict=True):
        assert length == pytest.approx(found["source"]["mean_stride_length_m"] * one["leg_ratio"])


def test_without_legs_there_is_no_verification(fresh_lab: Lab) -> None:
    """A verification without mapped legs is refused and names the joints to map."""
    view = uploaded(fresh_lab.operator, walk_bvh())
    path = f"/api/captures/{view['id']}"
    reply = ok(fresh_lab.operator.get(f"{path}/joint-map"))
    upper = {joint: name for joint, name in reply["joint_map"].items() if "Leg" not in joint}
    ok(fresh_lab.operator.put(f"{path}/joint-map", json={"joint_map": upper, "version": 0}))
    answer = fresh_lab.operator.get(f"{path}/verification?avatars=165cm")
    refusal = error(answer, 422, "invalid_input")
    assert "LeftUpperLeg" in refusal["message"]
