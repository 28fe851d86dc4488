"""Tests of the avatar's body: its joint positions, optional parts and segment lengths."""

import numpy as np
import pytest

from app.science.avatar.body.body import REQUIRED_PARTS, Body, BodyError, build_body
from app.science.avatar.body.parts import FINGER_PARTS, PARENT_OF, PART_NAMES, mirrored_name
from app.science.avatar.body.proportions import SEGMENT_NAMES, segment_lengths
from app.science.avatar.body.shapes import Box, Capsule
from app.science.rotations.scalars import v_add, v_length, v_subtract
from app.science.skeleton import JOINT_NAMES, build_skeleton


def _without(*absent: str) -> list[str]:
    return [part for part in PART_NAMES if part not in absent]


@pytest.mark.parametrize("stature_m", [0.5, 1.518, 1.75, 2.6])
def test_the_body_joints_are_those_of_the_skeleton(stature_m: float) -> None:
    """All 22 joints lie at exactly the same offsets as in the product's skeleton."""
    body, skeleton = build_body(stature_m), build_skeleton(stature_m)
    offsets = np.array([body.parts[name].joint_m for name in JOINT_NAMES])
    assert np.array_equal(offsets, skeleton.offsets_m)
    for index, name in enumerate(JOINT_NAMES):
        if not name.endswith("Hand"):
            assert body.parts[name].end_m == tuple(skeleton.ends_m[index])


def test_the_middle_finger_ends_near_the_tip_of_the_hand() -> None:
    """The palm and the middle finger's segments add up to .990 of the hand's length.

    Buchholz 1992: palm .446, segments .266, .170 and .108.
    """
    body = build_body(1.75)
    tip = v_add(body.places_m()["LeftMiddleDistal"], body.parts["LeftMiddleDistal"].end_m)
    reach = v_length(v_subtract(tip, body.places_m()["LeftHand"]))
    assert reach == pytest.approx(0.990 * 0.108 * 1.75)


def test_fingers_lie_in_their_order_with_the_thumb_in_front() -> None:
    """In the T-pose the thumb is foremost (-z) and the little finger hindmost, palms down."""
    places = build_body(1.75).places_m()
    for side in ("Left", "Right"):
        tips = [places[f"{side}{f}Distal"][2] for f in ("Thumb", "Index", "Middle", "Ring")]
        assert tips == sorted(tips)
        assert places[f"{side}RingDistal"][2] < places[f"{side}LittleDistal"][2]


def test_both_sides_are_mirror_images() -> None:
    """Left joints, bone ends and shapes are the right ones mirrored at x = 0."""
    body = build_body(1.8)
    for name, part in body.parts.items():
        other = body.parts[mirrored_name(name)]
        assert _mirrored(part.joint_m) == other.joint_m
        assert _mirrored(part.end_m) == other.end_m
        for shape, twin in zip(part.shapes, other.shapes, strict=True):
            if isinstance(shape, Box):
                assert isinstance(twin, Box)
                assert _mirrored(shape.center_m) == twin.center_m
                assert shape.half_size_m == twin.half_size_m
            else:
                assert isinstance(twin, Capsule)
                assert shape.radius_m == twin.radius_m
                ends = {_mirrored(shape.start_m), _mirrored(shape.end_m)}
                assert ends == {twin.start_m, twin.end_m}


def _mirrored(v: tuple[float, float, float]) -> tuple[float, float, float]:
    return (-v[0], v[1], v[2])


@pytest.mark.parametrize("stature_m", [1.5, 1.75, 2.0])
def test_its_shapes_reach_from_the_floor_to_the_stature(stature_m: float) -> None:
    """In the T-pose the soles lie on the floor and the top of the head is at the stature."""
    body = build_body(stature_m)
    places = body.places_m()
    low, high = [], []
    for name, part in body.parts.items():
        for shape in part.shapes:
            if isinstance(shape, Box):
                middle, half = shape.center_m[1], shape.half_size_m[1]
                low.append(places[name][1] + middle - half)
                high.append(places[name][1] + middle + half)
            else:
                ends = (shape.start_m[1], shape.end_m[1])
                low.append(places[name][1] + min(ends) - shape.radius_m)
                high.append(places[name][1] + max(ends) + shape.radius_m)
    assert min(low) == pytest.approx(0.0, abs=1e-12)
    assert max(high) == pytest.approx(stature_m)


@pytest.mark.parametrize("name", SEGMENT_NAMES)
def test_a_measured_length_replaces_the_expected_one(name: str) -> None:
    """Each segment takes its measured length, and the feet stay on the floor."""
    measured = 1.1 * segment_lengths(1.75)[name]
    body = build_body(1.75, segments_m={name: measured})
    places = body.places_m()
    assert _lengths(body)[name] == pytest.approx(measured)
    for other in set(SEGMENT_NAMES) - {name}:
        assert _lengths(body)[other] == pytest.approx(segment_lengths(1.75)[other])
    assert places["LeftFoot"][1] == pytest.approx(0.039 * 1.75)


def _lengths(body: Body) -> dict[str, float]:
    """Return the segment lengths of a built body, measured between its joints."""
    at, end = body.places_m(), {name: part.end_m for name, part in body.parts.items()}

    def between(a: str, b: str) -> float:
        return v_length(v_subtract(at[a], at[b]))

    toe_tip = at["LeftToes"][2] + end["LeftToes"][2]
    finger_tip = at["LeftMiddleDistal"][0] + end["LeftMiddleDistal"][0]
    (foot,) = body.parts["LeftFoot"].shapes
    assert isinstance(foot, Box)
    heel = at["LeftFoot"][2] + foot.center_m[2] + foot.half_size_m[2]
    return {
        "upper_arm": between("LeftUpperArm", "LeftLowerArm"),
        "forearm": between("LeftLowerArm", "LeftHand"),
        "hand": abs(finger_tip - at["LeftHand"][0]) / 0.990,
        "thigh": between("LeftUpperLeg", "LeftLowerLeg"),
        "shank": between("LeftLowerLeg", "LeftFoot"),
        "foot": heel - toe_tip,
        "trunk": at["Neck"][1] - at["Hips"][1],
        "head": at["Head"][1] + end["Head"][1] - at["Neck"][1],
        "shoulders": between("LeftUpperArm", "RightUpperArm"),
        "hips": between("LeftUpperLeg", "RightUpperLeg"),
    }


@pytest.mark.parametrize(
    ("segments", "words"),
    [
        ({"thigh": 43.0}, ["thigh", "43.0", "0.300", "0.557", "metres"]),
        ({"hand": float("nan")}, ["hand", "nan"]),
        ({"tail": 0.3}, ["tail", "upper_arm", "shoulders"]),
    ],
)
def test_an_implausible_length_is_rejected(segments: dict[str, float], words: list[str]) -> None:
    """The error about an implausible segment length names the segment, the value and the range."""
    with pytest.raises(BodyError) as caught:
        build_body(1.75, segments_m=segments)
    assert all(word in str(caught.value) for word in words)


@pytest.mark.parametrize("stature_m", [0.4, 175.0, float("nan")])
def test_an_impossible_stature_is_rejected(stature_m: float) -> None:
    """A stature in centimetres, out of range, or that is not a number raises an error."""
    with pytest.raises(BodyError, match="stature"):
        build_body(stature_m)


@pytest.mark.parametrize("missing", REQUIRED_PARTS)
def test_a_model_without_a_required_part_is_no_humanoid(missing: str) -> None:
    """A model that lacks a required part raises an error that names that part."""
    with pytest.raises(BodyError, match=f"no {missing}, so it is not a humanoid"):
        build_body(1.75, parts=_without(missing))


def test_a_model_that_is_nothing_like_a_human_is_rejected() -> None:
    """A quadruped's bones give one error that names all missing parts."""
    with pytest.raises(BodyError) as caught:
        build_body(1.75, parts=["Spine", "FrontLeftPaw", "Tail"])
    assert "Hips, Head" in str(caught.value)


def test_children_of_a_missing_part_attach_to_the_next_part_above() -> None:
    """Joints stay in place when Chest, UpperChest, Neck and shoulders are missing."""
    absent = ("Chest", "UpperChest", "Neck", "LeftShoulder", "RightShoulder", "LeftToes")
    whole, body = build_body(1.75), build_body(1.75, parts=_without(*absent))
    assert body.parts["Head"].parent == "Spine"
    assert body.parts["LeftUpperArm"].parent == "Spine"
    for name, place in body.places_m().items():
        assert place == pytest.approx(whole.places_m()[name], abs=1e-12)
        above = body.parts[name].parent
        if above is not None:
            seen = v_add(body.places_m()[above], body.parts[name].joint_m)
            assert seen == pytest.approx(place, abs=1e-12)


def test_the_shapes_of_a_missing_part_stay_where_they_were() -> None:
    """The shapes of a missing Chest and UpperChest are attached to the spine."""
    body = build_body(1.75, parts=_without("Chest", "UpperChest"))
    shapes = body.parts["Spine"].shapes
    assert len(shapes) == 3
    places = build_body(1.75).places_m()
    heights = [s.start_m[1] for s in shapes if isinstance(s, Capsule)]
    chest = build_body(1.75).parts["Chest"].shapes[0]
    assert isinstance(chest, Capsule)
    assert heights[1] == pytest.approx(places["Chest"][1] - places["Spine"][1] + chest.start_m[1])


def test_a_hand_of_four_fingers_has_no_fifth() -> None:
    """A model without ring fingers has neither their parts nor their shapes."""
    ring = [part for part in FINGER_PARTS if "Ring" in part]
    body = build_body(1.75, parts=_without(*ring))
    assert len(body.parts) == 46
    assert len(body.parts["LeftHand"].shapes) == 1


def test_a_finger_of_two_segments_keeps_its_length() -> None:
    """The shape of a missing last finger segment is added to the segment before it."""
    body = build_body(1.75, parts=_without("LeftIndexDistal"))
    assert len(body.parts["LeftIndexIntermediate"].shapes) == 2


def test_a_hand_without_fingers_is_one_box_as_long_as_the_hand() -> None:
    """Without fingers, the hand is one box from the wrist to the fingertip."""
    body = build_body(1.75, parts=_without(*FINGER_PARTS))
    (box,) = body.parts["RightHand"].shapes
    assert isinstance(box, Box)
    assert 2.0 * box.half_size_m[0] == pytest.approx(0.108 * 1.75)
    assert body.parts["RightHand"].end_m == pytest.approx((0.108 * 1.75, 0.0, 0.0))


def test_names_of_other_bones_are_skipped() -> None:
    """Bones that are not body parts, such as eyes and jaw, are ignored."""
    body = build_body(1.75, parts=[*PART_NAMES, "LeftEye", "Jaw"])
    assert tuple(body.parts) == PART_NAMES


def test_parts_come_parents_first() -> None:
    """Every part's parent is present and is listed before the part."""
    body = build_body(1.75)
    seen: set[str | None] = {None}
    for name, part in body.parts.items():
        assert part.parent == PARENT_OF[name]
        assert part.parent in seen
        seen.add(name)
