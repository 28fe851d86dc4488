"""Measure retargeting: the time of one live frame, and the frames per second of a file.

`frame` is a live frame of 22 joints, timed call by call; the budget of a 360 Hz capture is 2.8 ms,
the limit here 50 microseconds at the 99.9th percentile. Calls during which the system gave the
processor to another program are included in one row of the table and left out of the other. `batch`
is a movement of 22 joints on one core, at least a million frames a second. `peers` is a walk of 31
joints (CMU 02_01 if the shared data are available, else a synthetic one), compared with SciPy's
Rotation and PyMotion doing the same work. `anatomy` checks every capture of the shared data
(`retargeting_anatomy`): one row each in `rows`, and refusals by rule in `refused`. Rates are
medians of several rounds, so that other programs on the machine affect few of them.
"""

import resource
import time
from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from app.adapters.bvh import read_bvh
from app.science.retargeting import Retargeter, propose_joint_map
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, geodesic_angle, identity
from tests.benchmarks import retargeting_anatomy as anatomy
from tests.benchmarks import retargeting_peers as peers
from tests.benchmarks.report import Figure, Report
from tests.science.retargeting.bodies import SAME, own_body, random_movement, scaled
from tests.support.shared_data import shared_data_folder

PARTS = ("frame", "batch", "peers", "anatomy")
ROUNDS, CALLS, FRAMES = 7, 10_000, 20_000
FRAME_LIMIT_US, BATCH_LIMIT = 50.0, 1e6
METRES_PER_CMU_UNIT = 0.056444
SAME_RESULT_RAD = 1e-6


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("retargeting")
    body = own_body(1.7)
    motion = random_movement(body, np.random.default_rng(1), FRAMES)
    retargeter = Retargeter(body, SAME, own_body(1.9), SAME)
    retargeter.batch(motion)
    if "frame" in parts:
        report.add(*_frame(retargeter, motion))
    if "batch" in parts:
        rate = _frames_per_s(lambda: retargeter.batch(motion), FRAMES)
        report.add(Figure("batch", "22 joints", rate, "frames/s", "at least", BATCH_LIMIT))
    if "peers" in parts:
        report.add(*_beside_peers())
    if "anatomy" in parts:
        found = list(anatomy.rows())
        report.add(*anatomy.figures(found))
        report.beside |= {"rows": found, "refused": anatomy.refusals(found)}
    return report


def _frame(retargeter: Retargeter, motion: RigMotion) -> Iterator[Figure]:
    rounds = [_timed_calls(retargeter, motion) for _ in range(ROUNDS)]
    everything = np.concatenate([times_us for times_us, _ in rounds])
    alone = np.concatenate([times_us[undisturbed] for times_us, undisturbed in rounds])
    for told, times_us in (("all calls", everything), ("calls not interrupted", alone)):
        for name, percent in (("p50", 50.0), ("p99", 99.0)):
            value = float(np.percentile(times_us, percent))
            yield Figure("frame", f"22 joints, {told}, {name}", value, "us")
        worst = float(np.percentile(times_us, 99.9))
        name = f"22 joints, {told}, p99.9"
        yield Figure("frame", name, worst, "us", "at most", FRAME_LIMIT_US)
    share = 100.0 * (1.0 - len(alone) / len(everything))
    yield Figure("frame", "calls that another program interrupted", share, "%")


def _timed_calls(
    retargeter: Retargeter, motion: RigMotion
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return each call's time in microseconds, and whether it was not interrupted."""
    roots, rotations = list(motion.root_positions_m), list(motion.rotations)
    times_ns, switches = np.empty(CALLS), np.empty(CALLS + 1, dtype=np.int64)
    for at in range(CALLS):
        root, local = roots[at], rotations[at]
        switches[at] = _switches()
        began_ns = time.perf_counter_ns()
        retargeter.frame(root, local)
        times_ns[at] = time.perf_counter_ns() - began_ns
    switches[CALLS] = _switches()
    return times_ns / 1e3, np.diff(switches) == 0


def _switches() -> int:
    """Return how often the system has preempted this thread."""
    return resource.getrusage(resource.RUSAGE_THREAD).ru_nivcsw


def _beside_peers() -> Iterator[Figure]:
    name, motion = _walk()
    joint_map = propose_joint_map(motion.rig).joint_map
    avatar = scaled(motion.rig, 1.1)
    retargeter = Retargeter(motion.rig, joint_map, avatar, joint_map)
    task = peers.Task(
        motion.rig.parents,
        avatar.parents,
        motion.rig.offsets_m,
        tuple(retargeter.moved_by.tolist()),
        retargeter.factors,
    )
    frames = motion.frame_count
    ours = retargeter.batch(motion).rotations
    rate = _frames_per_s(lambda: retargeter.batch(motion), frames, repeat=20)
    told = f"{name}, {motion.rig.joint_count} joints"
    for peer, work in (
        ("SciPy, frame by frame", peers.by_scipy_frame_by_frame),
        ("SciPy, all frames per joint", peers.by_scipy),
        ("PyMotion, all frames per joint", peers.by_pymotion),
    ):
        gap = float(np.max(geodesic_angle(work(task, motion.rotations), ours)))
        if gap > SAME_RESULT_RAD:
            raise AssertionError(f"{peer} is {gap} rad off: it does not do the same work.")
        theirs = _frames_per_s(_call(work, task, motion.rotations), frames)
        yield Figure("peers", told, rate, "frames/s", peer, theirs)


def _call(
    work: Callable[[peers.Task, FloatArray], FloatArray], task: peers.Task, rotations: FloatArray
) -> Callable[[], object]:
    return lambda: work(task, rotations)


def _frames_per_s(work: Callable[[], object], frames: int, repeat: int = 1) -> float:
    times_s = []
    for _ in range(ROUNDS):
        began_s = time.perf_counter()
        for _ in range(repeat):
            work()
        times_s.append((time.perf_counter() - began_s) / repeat)
    return frames / float(np.median(times_s))


def _walk() -> tuple[str, RigMotion]:
    path = shared_data_folder() / "motion" / "cmu_bvh" / "02_01.bvh"
    if not path.is_file():
        return "made-up walk", _made_up()
    clip = read_bvh(path, metres_per_unit=METRES_PER_CMU_UNIT)
    rig = Rig(clip.names, clip.parents, clip.offsets_m, identity(len(clip.names)))
    local, roots = clip.rotations, clip.translations_m[:, 0]
    seen = np.ones(local.shape[:2], dtype=bool)
    return "CMU 02_01", RigMotion(rig, 1.0 / clip.frame_time_s, roots, local, seen)


def _made_up() -> RigMotion:
    """Return a synthetic movement of a body with nine finger joints: 31 joints, 344 frames."""
    body = own_body(1.7)
    hands = [body.index("LeftHand"), body.index("RightHand")]
    names = tuple(f"Finger{number}" for number in range(9))
    rig = Rig(
        (*body.names, *names),
        (*body.parents, *(hands[number % 2] for number in range(9))),
        np.concatenate((body.offsets_m, np.full((9, 3), 0.05))),
        identity(31),
    )
    return random_movement(rig, np.random.default_rng(2), 344)
