"""Tests of `reembody retarget`: figures, files and refusals."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.adapters.bvh import read_bvh
from app.adapters.captures.bvh_export import to_bvh
from app.cli.retarget.inputs import ground_along
from app.science.anatomy import mirrored_skeleton
from app.science.retargeting import reference_avatar
from app.science.rig import Rig, RigMotion
from tests.cli.invoked import Invoked
from tests.science.retargeting.bodies import scaled
from tests.science.retargeting.test_floor_clearance import curved_and_sinking
from tests.science.retargeting.walks import made_walk

_KEYS = [
    "frames",
    "fps",
    "leg_ratio",
    "stride_lengths_m",
    "step_lengths_m",
    "step_heights_m",
    "foot_slide_m_s",
    "unmapped_joints",
    "floor",
    "notices",
    "conventions",
]
_COMMAND = Invoked("retarget")
_run, _figures, _refusal = _COMMAND.run, _COMMAND.figures, _COMMAND.refusal


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Return a BVH file of a generated walk of a person of 1.75 m."""
    path = tmp_path / "walk.bvh"
    path.write_text(to_bvh(made_walk(reference_avatar(1.75)).motion))
    return path


@pytest.mark.parametrize("factor", [0.01, 2.54])
def test_a_body_of_no_human_size_is_noted_with_the_unit_that_was_used(
    tmp_path: Path, factor: float
) -> None:
    """A clip whose unit is wrong is noted by the stature it implies; JSON names unit and origin."""
    path = tmp_path / "walk.bvh"
    path.write_text(to_bvh(made_walk(reference_avatar(1.75)).motion))
    right = _figures(path, "--to", "165cm")
    assert [one["rule"] for one in right["notices"]] == []
    assert right["conventions"]["length"]["origin"] == "guessed"
    unit = float(right["stride_lengths_m"]["source"][0])
    metres = {"cm": 0.01, "mm": 0.001, "m": 1.0}[right["conventions"]["length"]["value"]]
    wrong = _figures(path, "--to", "165cm", "--unit", metres * factor)
    (notice,) = wrong["notices"]
    assert (notice["rule"], notice["action"]) == ("length", "noted")
    assert "0.5 to 2.6 m" in notice["valid"]
    assert wrong["conventions"]["length"]["origin"] == "chosen"
    assert wrong["stride_lengths_m"]["source"][0] == pytest.approx(factor * unit, rel=1e-3)
    assert "size is not a human's" in _run(path, "--to", "165cm", "--unit", metres * factor).stdout


def test_json_has_exactly_its_keys_and_steps_scale_with_the_legs(clip: Path) -> None:
    """The JSON has exactly its keys, and each step scales with the ratio of the legs."""
    figures = _figures(clip, "--to", "130cm")
    assert list(figures) == _KEYS
    assert figures["frames"] == made_walk(reference_avatar(1.75)).motion.frame_count
    assert figures["fps"] == pytest.approx(120.0, abs=1e-3)
    assert figures["leg_ratio"] == pytest.approx(1.30 / 1.75, abs=1e-9)
    assert figures["unmapped_joints"] == []
    for key in ("stride_lengths_m", "step_heights_m"):
        steps = figures[key]
        assert isinstance(steps, dict)
        ratios = np.array(steps["avatar"]) / np.array(steps["source"])
        assert len(ratios) == 5
        assert ratios == pytest.approx(np.full(5, 1.30 / 1.75), abs=1e-9)


def test_another_file_can_be_the_avatar(clip: Path, tmp_path: Path) -> None:
    """The skeleton of another file can be the avatar, without its movement."""
    rig = scaled(reference_avatar(1.75), 0.5)
    still = RigMotion(
        Rig(rig.names, rig.parents, rig.offsets_m, rig.rest_rotations, rig.ends),
        30.0,
        rig.offsets_m[:1],
        rig.rest_rotations[np.newaxis],
        np.ones((1, rig.joint_count), dtype=np.bool_),
    )
    avatar = tmp_path / "small.bvh"
    avatar.write_text(to_bvh(still))
    assert _figures(clip, "--to", avatar)["leg_ratio"] == pytest.approx(0.5, abs=1e-9)


def test_the_output_files_have_the_avatars_movement(clip: Path, tmp_path: Path) -> None:
    """The output is the avatar's movement as BVH in centimetres or CSV, and no other file."""
    bvh, table = tmp_path / "out.bvh", tmp_path / "out.csv"
    assert _run(clip, "--to", "190cm", "--out", bvh).exit_code == 0
    assert _run(clip, "--to", "190cm", "--out", table).exit_code == 0
    written = read_bvh(bvh, metres_per_unit=0.01)
    knee = written.names.index("LeftLowerLeg")
    assert np.linalg.norm(written.offsets_m[knee]) == pytest.approx(0.245 * 1.90, abs=1e-9)
    with table.open(newline="") as file:
        rows = list(csv.reader(file))
    assert len(rows) == written.frame_count + 1
    column = rows[0].index("Hips.y_m")
    assert float(rows[1][column]) == pytest.approx(written.root_positions_m[0, 1], abs=1e-8)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.bvh", "out.csv", "walk.bvh"]


def test_locking_the_feet_reduces_their_slide(clip: Path) -> None:
    """Locking the feet reduces their slide, which is reported for the output."""
    free, locked = (
        _figures(clip, "--to", "165cm"),
        _figures(clip, "--to", "165cm", "--lock-feet"),
    )
    assert isinstance(free["foot_slide_m_s"], float)
    assert isinstance(locked["foot_slide_m_s"], float)
    assert locked["foot_slide_m_s"] < 1e-6 < free["foot_slide_m_s"]


def test_the_avatar_follows_the_ground(clip: Path, tmp_path: Path) -> None:
    """The avatar's hips rise by the height of a kerb, with and without locked feet."""
    for lock in ((), ("--lock-feet",)):
        out = tmp_path / "up.bvh"
        ground = ("--ground", "kerb:0.12@1.0")
        assert _run(clip, "--to", "165cm", "--out", out, *ground, *lock).exit_code == 0
        hips = read_bvh(out, metres_per_unit=0.01).root_positions_m
        assert hips[-1, 1] - hips[0, 1] == pytest.approx(0.12, abs=2e-3)


def test_the_text_output_is_a_table_with_units(clip: Path, tmp_path: Path) -> None:
    """The text output has conventions, steps, slide, unmapped joints and the file written."""
    out = tmp_path / "out.bvh"
    message = _run(clip, "--to", "165cm", "--lock-feet", "--out", out).stdout
    for words in ("unit", "guessed", "step length, mean", "m/s", "with feet held", "unmapped"):
        assert words in message
    assert f"written: {out}" in message


def test_a_joint_map_can_be_given(clip: Path, tmp_path: Path) -> None:
    """A joint map can be given; joints that it leaves out are listed as unmapped."""
    rig = reference_avatar(1.75)
    joint_map = {name: name for name in rig.names if name != "UpperChest"}
    path = tmp_path / "map.json"
    path.write_text(json.dumps(joint_map))
    figures = _figures(clip, "--to", "165cm", "--joint-map", path)
    assert figures["unmapped_joints"] == ["UpperChest"]


def test_unit_and_axis_can_be_given(tmp_path: Path) -> None:
    """The unit of a file can be given, and an invalid axis is refused."""
    motion = made_walk(reference_avatar(1.75)).motion
    path = tmp_path / "inches.bvh"
    path.write_text(to_bvh(motion, metres_per_unit=0.0254))
    figures = _figures(path, "--to", "165cm", "--unit", "0.0254")
    assert figures["leg_ratio"] == pytest.approx(1.65 / 1.75, abs=1e-9)
    assert "x, y and z are valid" in _refusal(path, "--to", "165cm", "--up", "w")


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("--to", "Faye"), "130cm, 165cm, 190cm"),
        (("--to", "300cm"), "0.5 to 2.6 m"),
        ((), "--to are needed"),
        (("--to", "165cm", "--out", "out.fbx"), ".bvh or .csv"),
        (("--to", "165cm", "--out", "nowhere/out.bvh"), "no folder"),
        (("--to", "165cm", "--out", "walk.bvh"), "the clip itself"),
        (("--to", "165cm", "--ground", "hill"), "kerb:HEIGHT@DISTANCE"),
        (("--to", "165cm", "--ground", "ramp:1/0@1"), "kerb:HEIGHT@DISTANCE"),
        (("--to", "165cm", "--joint-map", "walk.bvh"), "not valid JSON"),
        (("--to", "165cm", "--joint-map", "missing.json"), "missing.json"),
        (("--to", "165cm", "--skeleton", "missing.asf"), "missing.asf"),
        (("--to", "165cm", "--unit", "0"), "m per unit"),
        (("--check", "table2"), "table1 is valid"),
    ],
)
def test_invalid_arguments_are_refused_with_the_reason(
    clip: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], reason: str
) -> None:
    """Invalid arguments are refused with the reason and exit code 2, and no file is changed."""
    monkeypatch.chdir(clip.parent)
    before = clip.read_bytes()
    assert reason in _refusal("walk.bvh", *arguments)
    assert [path.name for path in clip.parent.iterdir()] == ["walk.bvh"]
    assert clip.read_bytes() == before


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "the text ends"),
        (b"HIERARCHY\nROOT Hips\n{\n", "line 3"),
        (bytes(range(256)), "expected 'HIERARCHY'"),
    ],
)
def test_broken_files_are_refused_and_nothing_is_written(
    tmp_path: Path, content: bytes, reason: str
) -> None:
    """A broken file is refused with its name and the position, and nothing is written."""
    path, out = tmp_path / "broken.bvh", tmp_path / "out.bvh"
    path.write_bytes(content)
    output = _refusal(path, "--to", "165cm", "--out", out)
    assert str(path) in output
    assert reason in output
    assert not out.exists()


def test_an_invalid_joint_map_is_refused(clip: Path, tmp_path: Path) -> None:
    """A joint map with an unknown clip joint or body joint, or not an object, is refused."""
    path = tmp_path / "map.json"
    for joint_map, reason in (
        ({"Hips": "Pelvis"}, "no joint 'Pelvis'"),
        ({"Hips": "Hips", "Tail": "Spine"}, "not a joint of the body"),
        (["Hips"], "one object"),
        ({"Hips": 3}, "one object"),
    ):
        path.write_text(json.dumps(joint_map))
        assert reason in _refusal(clip, "--to", "165cm", "--joint-map", path)


def test_the_ground_option_is_parsed() -> None:
    """The ground option gives kerbs and ramps along the way from the hips' start to their end."""
    hips = np.array(((1.0, 0.9, 2.0), (1.0, 0.9, -3.0)))
    kerb, ramp = ground_along("kerb:-0.1@2"), ground_along("ramp:0.5/2@1")
    assert ground_along("flat") is None
    assert kerb is not None
    assert ramp is not None
    assert kerb(hips).height_m(np.ones(2), np.array((0.1, -0.1))).tolist() == [0.0, -0.1]
    heights = ramp(hips).height_m(np.ones(3), np.array((1.5, 0.0, -2.0)))
    assert heights == pytest.approx((0.0, 0.25, 0.5))
    with pytest.raises(ValueError, match="hips do not move"):
        kerb(hips[:1])


def test_table_1_is_reproduced() -> None:
    """All 22 rows of table 1 but the pelvis are reproduced within 0.01 degrees."""
    result = _run("--check", "table1", "--json")
    rows = json.loads(result.stdout)["rows"]
    assert [list(row) for row in rows] == [["joint", "printed", "computed", "difference_deg"]] * 22
    apart = [row["joint"] for row in rows if row["difference_deg"] > 0.01]
    assert apart == ["pelvis"]
    output = _run("--check", "table1").stdout
    assert "21 of 22 rows agree" in output
    assert "the source contradicts itself" in output


@pytest.mark.parametrize(
    ("name", "frames", "steps"), [("cmu_bvh/02_01.bvh", 343, 4), ("cmu_asfamc/02_01.amc", 343, 4)]
)
def test_real_captures_are_retargeted(
    shared_data: Path, name: str, frames: int, steps: int
) -> None:
    """A real walk is retargeted from BVH, and from AMC with the ASF next to it."""
    figures = _figures(shared_data / "motion" / name, "--to", "165cm")
    lengths = figures["stride_lengths_m"]
    assert figures["frames"] == frames
    assert isinstance(lengths, dict)
    assert len(lengths["source"]) == len(lengths["avatar"]) == steps


def test_a_mirrored_walk_is_mirrored_back_and_named(tmp_path: Path) -> None:
    """A walk in left-handed axes gives the figures of the walk itself, and a notice."""
    walk = made_walk(reference_avatar(1.75)).motion
    here, there = tmp_path / "walk.bvh", tmp_path / "mirrored.bvh"
    here.write_text(to_bvh(walk))
    there.write_text(to_bvh(mirrored_skeleton(walk)))
    right, mirrored = _figures(here, "--to", "165cm"), _figures(there, "--to", "165cm")
    assert right["notices"] == []
    (notice,) = mirrored["notices"]
    assert (notice["rule"], notice["action"]) == ("mirrored", "mended")
    assert {"what", "value", "valid", "remedy"} < set(notice)
    assert mirrored["step_heights_m"]["avatar"] == pytest.approx(
        right["step_heights_m"]["avatar"], abs=1e-4
    )
    assert "Left and right are mirrored" in _run(there, "--to", "165cm").stdout


def test_the_floor_is_in_the_answer(tmp_path: Path) -> None:
    """A curved walk whose floor sinks says how deep its feet were, are, and what that cost."""
    path = tmp_path / "curved.bvh"
    path.write_text(to_bvh(curved_and_sinking(0.05)))
    floor = _figures(path, "--to", "165cm")["floor"]
    assert floor["sunk_m"] > 0.03
    assert floor["left_m"] <= 0.01
    assert floor["raised_m"] > floor["mean_raised_m"] > 0.0
    assert "before the body was raised" in _run(path, "--to", "165cm").stdout


def test_locked_feet_stay_above_the_floor(shared_data: Path) -> None:
    """Toes that point down through the floor lift their foot, and the answer says how far."""
    clip = shared_data / "motion" / "cmu_bvh" / "05_06.bvh"
    locked = _figures(clip, "--to", "165cm", "--lock-feet")
    floor = locked["floor"]
    assert floor["sunk_m"] > 0.19
    assert floor["left_m"] <= 0.01
    assert (floor["raised_m"], floor["mean_raised_m"]) == (0.0, 0.0)
    assert floor["lifted_m"] == pytest.approx(0.069, abs=0.001)
    assert locked["foot_slide_m_s"] < 1e-6
    assert (
        "single feet lifted by at most 6.9 cm" in _run(clip, "--to", "165cm", "--lock-feet").stdout
    )


def test_a_unit_that_only_the_body_tells_is_named(tmp_path: Path) -> None:
    """A BVH in inches is 2.54 times as large as in centimetres: the answer says that it was so."""
    walk = made_walk(reference_avatar(1.75)).motion
    path = tmp_path / "inches.bvh"
    small = scaled(walk.rig, 1.0 / 2.54)
    roots_m = walk.root_positions_m / 2.54
    path.write_text(to_bvh(replace(walk, rig=small, root_positions_m=roots_m)))
    found = _figures(path, "--to", "165cm")
    (notice,) = found["notices"]
    assert (notice["rule"], notice["action"]) == ("unit", "noted")
    assert "if the unit is inch, which is 2.54 times as large as in cm" in notice["value"]
    assert found["conventions"]["length"]["origin"] == "guessed"
    told = _figures(path, "--to", "165cm", "--unit", "0.0254")
    assert told["notices"] == []
    assert told["stride_lengths_m"]["source"] == pytest.approx(found["stride_lengths_m"]["source"])


def test_a_map_that_exchanges_the_sides_is_refused(clip: Path, tmp_path: Path) -> None:
    """A map with left and right exchanged is refused with value and remedy; nothing is written."""
    other = {"Left": "Right", "Right": "Left"}
    swapped = {
        name: name.replace(side, other[side])
        for name in reference_avatar(1.75).names
        for side in ("Left", "Right")
        if side in name
    }
    exchanged = tmp_path / "map.json"
    exchanged.write_text(json.dumps({"Hips": "Hips", **swapped}))
    out = tmp_path / "out.bvh"
    told = _refusal(clip, "--to", "165cm", "--joint-map", exchanged, "--out", out)
    for part in ("exchanges left and right", "Found: 0 % of the knees", "Exchange left and right"):
        assert part in told
    assert not out.exists()
