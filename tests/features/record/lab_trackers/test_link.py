"""Tests of a session's trackers in the headset's world, by times that are arguments."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from app.adapters.live import Pose
from app.features.movement.live import Sample
from app.features.record.lab_trackers.link import SILENT_S, STALE_S, TrackerLink
from app.features.record.lab_trackers.worker_tasks import watch_step
from app.science.alignment import PoseStream
from app.science.rotations import FloatArray, from_rotation_vector, identity, rotate
from app.wire import HeadPose
from tests.science.alignment.rooms import (
    FOOT_FROM_HEAD_M,
    OPTICAL,
    Room,
    in_tracking_world,
    joined,
    looking_around,
    moved_world,
    recorded,
    some_room,
)

SERVER_S, HEADSET_S = 5000.0, 40.0
"""What the two clocks show at time 0 of the room."""
RECENTRED_S = 15.3
TURN: FloatArray = from_rotation_vector(np.array((0.0, 0.6, 0.0)))
SHIFT_M: FloatArray = np.array((0.4, 0.0, -0.3))
HERE = "127.0.0.1:5000"
WORN = {"hat": "Head", "left": "LeftLowerLeg", "chest": "Chest"}


def sample(at_s: float, *poses: Pose, address: str = HERE) -> Sample:
    """Return what trackers of the source said at a time of the room, without a clock of its own."""
    arrival_s = SERVER_S + at_s
    return Sample("json", "lab", address, poses, None, arrival_s, arrival_s, None)


def tracker(name: str, position_m: FloatArray, rotation: FloatArray) -> Pose:
    """Return a pose of a tracker."""
    return Pose(name, "tracker", tuple(position_m), tuple(rotation))


def head_pose(at_s: float, position_m: FloatArray, rotation: FloatArray) -> HeadPose:
    """Return where the headset says that its wearer's head was at a time of the room."""
    place = (*position_m, *rotation)
    return HeadPose(t_s=HEADSET_S + at_s, place=place, tracked=True)


def live(
    link: TrackerLink, headset: PoseStream, hat: PoseStream, head: PoseStream, room: Room
) -> Iterator[tuple[float, float | None]]:
    """Let a room's streams arrive in order; yield times, and how far the foot is off at each.

    The foot's tracker is late by the room's delay, as the head's is.
    """
    feet = head.positions_m + np.array(FOOT_FROM_HEAD_M)
    feet_m = in_tracking_world(room, head.times_s, feet)
    seen = PoseStream.of(head.times_s + room.delay_s, feet_m, identity(len(feet)))
    where, turned, weight = seen.at(hat.times_s)
    news = sorted(
        [(float(at), 0, n) for n, at in enumerate(headset.times_s)]
        + [(float(at), 1, n) for n, at in enumerate(hat.times_s)]
    )
    due_s = 1.0
    for at, kind, n in news:
        if kind == 0:
            pose = head_pose(at, headset.positions_m[n], headset.rotations[n])
            link.take_head([pose], SERVER_S + at + 0.004)
            continue
        if weight[n] > 0:
            link.take(
                sample(
                    at,
                    tracker("hat", hat.positions_m[n], hat.rotations[n]),
                    tracker("left", where[n], turned[n]),
                )
            )
        if at >= due_s:
            due_s += 1.0
            due = link.to_watch(SERVER_S + at)
            if due is not None:
                number, watched, headset_rows, tracker_rows = due
                step = watch_step(watched, headset_rows, tracker_rows)
                assert link.take_step(number, step)
        # A tenth of the poses shows as much as all of them.
        if n % 10 == 0:
            yield at, _foot_error_m(link, at, headset)


def _foot_error_m(link: TrackerLink, at: float, headset: PoseStream) -> float | None:
    found = link.places(SERVER_S + at)
    if found is None or not found.places:
        return None
    position_m, _, weight = headset.at(np.array([found.t_s - HEADSET_S]))
    if weight[0] == 0:
        return None
    offset_m: FloatArray = np.array(FOOT_FROM_HEAD_M)
    if found.t_s - HEADSET_S >= RECENTRED_S:
        offset_m = rotate(TURN, offset_m)
    foot = np.array(found.places["LeftLowerLeg"][:3])
    return float(np.linalg.norm(foot - position_m[0] - offset_m))


def test_a_foot_is_where_it_is_also_after_a_recentre() -> None:
    """Nothing comes before looking around; then feet are within 5 mm, again after a recentre."""
    rng = np.random.default_rng(1)
    head, room = looking_around(23.0), some_room(rng)
    headset, hat = recorded(head, room, OPTICAL, rng)
    moved = joined(headset, moved_world(headset, TURN, SHIFT_M), RECENTRED_S)
    link = TrackerLink("json", "lab")
    link.wear(WORN)
    assert link.status(SERVER_S) == "silent"
    seen: list[tuple[float, float]] = []
    statuses: dict[str, float] = {}
    for at, error_m in live(link, moved, hat, head, room):
        statuses.setdefault(link.status(SERVER_S + at), at)
        if error_m is not None:
            seen.append((at, error_m))
    assert statuses["looking"] < 0.1
    assert 8.0 <= statuses["aligned"] < 13.0
    assert RECENTRED_S < statuses["lost"] < RECENTRED_S + 1.1
    before = [error_m for at, error_m in seen if at < RECENTRED_S]
    after = [error_m for at, error_m in seen if at > statuses["lost"]]
    assert float(np.percentile(before, 95)) <= 0.005
    assert float(np.percentile(after, 95)) <= 0.005
    assert len(after) > 20


def aligned_link(seconds: float = 10.5) -> tuple[TrackerLink, PoseStream, PoseStream]:
    """Return a link that was aligned for the first seconds of a room, and the room's streams."""
    rng = np.random.default_rng(3)
    head, room = looking_around(seconds), some_room(rng)
    headset, hat = recorded(head, room, OPTICAL, rng)
    link = TrackerLink("json", "lab")
    link.wear(WORN)
    for _ in live(link, headset, hat, head, room):
        pass
    assert link.status(SERVER_S + seconds - 0.2) == "aligned"
    return link, headset, hat


def test_what_is_lost_is_left_out() -> None:
    """An old pose, or one that its source lost, is not sent; then the source counts as silent."""
    link, _, hat = aligned_link()
    at = float(hat.times_s[-1])
    foot = tracker("left", np.zeros(3), np.array((1.0, 0.0, 0.0, 0.0)))
    assert link.take(sample(at + 0.01, foot))
    found = link.places(SERVER_S + at + 0.02)
    assert found is not None
    assert set(found.places) == {"LeftLowerLeg"}
    link.take(sample(at + 0.03, replace(foot, tracked=False)))
    found = link.places(SERVER_S + at + 0.04)
    assert found is not None
    assert found.places == {}
    link.take(sample(at + 0.05, foot))
    found = link.places(SERVER_S + at + 0.06 + STALE_S)
    assert found is not None
    assert found.places == {}
    assert link.status(SERVER_S + at + 1.1 * SILENT_S) == "silent"


def test_a_second_sender_of_the_same_name_is_named_and_not_used() -> None:
    """The first of two senders is used, until it has been silent for two seconds."""
    link, _, hat = aligned_link()
    at = float(hat.times_s[-1])
    foot = tracker("left", np.zeros(3), np.array((1.0, 0.0, 0.0, 0.0)))
    other = "127.0.0.1:6000"
    assert not link.take(sample(at + 0.1, foot, address=other))
    assert (link.address, link.others(SERVER_S + at + 0.2)) == (HERE, [other])
    assert link.others(SERVER_S + at + 0.2 + SILENT_S) == []
    assert link.take(sample(at + 0.2 + SILENT_S, foot, address=other))
    assert (link.address, link.others(SERVER_S + at + 0.2 + SILENT_S)) == (other, [])


def test_of_two_trackers_on_a_limb_the_first_by_name_is_used_while_it_sends() -> None:
    """Whatever their order in packets; the other one follows when the first was silent."""
    link, _, hat = aligned_link()
    link.wear({**WORN, "spare": "LeftLowerLeg"})
    at = float(hat.times_s[-1])
    upright = np.array((1.0, 0.0, 0.0, 0.0))
    first = tracker("left", np.zeros(3), upright)
    spare = tracker("spare", np.array((0.0, 0.0, 1.0)), upright)

    def place(at_s: float, *poses: Pose) -> tuple[float, ...]:
        link.take(sample(at_s, *poses))
        found = link.places(SERVER_S + at_s)
        assert found is not None
        return found.places["LeftLowerLeg"]

    alone = place(at + 0.01, first)
    assert link.doubled(SERVER_S + at + 0.01) == {}
    assert place(at + 0.02, spare, first) == pytest.approx(alone, abs=1e-4)
    assert place(at + 0.03, first, spare) == pytest.approx(alone, abs=1e-4)
    assert link.doubled(SERVER_S + at + 0.03) == {"LeftLowerLeg": ["left", "spare"]}
    seen = {one.tracker: one.is_used for one in link.trackers(SERVER_S + at + 0.03)}
    assert seen == {"hat": True, "left": True, "spare": False, "chest": False}
    later = at + 0.04 + SILENT_S
    link.take(sample(later, tracker("hat", hat.positions_m[-1], hat.rotations[-1])))
    assert np.linalg.norm(np.subtract(place(later, spare)[:3], alone[:3])) > 0.9
    assert link.doubled(SERVER_S + later) == {}
    assert place(later + 0.01, spare, first)[:3] == pytest.approx(alone[:3], abs=0.01)


def test_of_two_trackers_on_the_head_the_first_by_name_is_aligned() -> None:
    """A second one there changes nothing; only if the first falls silent, all starts anew."""
    link, _, hat = aligned_link()
    at = float(hat.times_s[-1])
    link.wear({**WORN, "visor": "Head"})
    visor = tracker("visor", hat.positions_m[-1], hat.rotations[-1])
    link.take(sample(at + 0.01, visor, tracker("hat", hat.positions_m[-1], hat.rotations[-1])))
    assert (link.reference, link.status(SERVER_S + at + 0.02)) == ("hat", "aligned")
    link.take(sample(at + 0.05 + SILENT_S, visor))
    assert link.reference == "visor"
    assert link.step() is None


def test_halves_of_a_pose_make_a_whole_one() -> None:
    """A position and a rotation that come in packets of their own, as VRChat's, are one pose."""
    link = TrackerLink("osc", "lab")
    link.wear({"1": "LeftLowerLeg"})
    position = Pose("1", "tracker", (0.1, 0.2, 0.3), None)
    rotation = Pose("1", "tracker", None, (1.0, 0.0, 0.0, 0.0))
    assert not link.take(sample(0.0, position))
    assert link.take(sample(0.0, rotation))
    assert [one.tracked for one in link.trackers(SERVER_S)] == [True]
    assert link.take(sample(0.1, position))


def test_a_page_that_is_loaded_anew_has_to_be_aligned_again() -> None:
    """A headset's clock that starts anew holds what is known back until it was fitted again.

    The same clock, after the network was gone, goes on at once.
    """
    link, headset, hat = aligned_link()
    at = float(hat.times_s[-1])
    link.begin_run()
    poses = [head_pose(at + 0.2, headset.positions_m[-1], headset.rotations[-1])]
    link.take_head(poses, SERVER_S + at + 0.21)
    assert link.places(SERVER_S + at + 0.3) is not None
    link.begin_run()
    anew = [one.model_copy(update={"t_s": 3.0}) for one in poses]
    link.take_head(anew, SERVER_S + at + 0.5)
    assert link.places(SERVER_S + at + 0.6) is None
    link.take(sample(at + 0.55, tracker("hat", hat.positions_m[-1], hat.rotations[-1])))
    assert link.status(SERVER_S + at + 0.6) == "lost"


def test_another_tracker_on_the_head_starts_anew() -> None:
    """What was known of the old one says nothing of the new one."""
    link, _, hat = aligned_link()
    at = SERVER_S + float(hat.times_s[-1])
    link.wear({**WORN, "cap": "Head", "hat": "Chest"})
    assert link.places(at) is None
    assert link.status(at) == "silent"
    link.wear({"left": "LeftLowerLeg"})
    assert link.status(at) == "no_reference"
