"""Fit the tracking system's world and the tracker on the head: hand-eye calibration.

At each of the headset's times t, with the tracker's pose taken at t + delay,

    headset_world_from_head = Y world_from_tracker X,

where Y (the tracking world in the headset's world) and X (the head in the tracker's axes) do not
change while somebody looks around; this is A X = Y B of Robot-World/Hand-Eye calibration.

1. The delay comes from the angular speeds (`delay`).
2. The turn of the head between two moments has the same axis as that of the tracker, apart from X:
   a rotation between two sets of vectors (Kabsch) is X's rotation, and Y's is the mean of what then
   remains. Positions follow from linear equations. Each is solved with decreasing weights of
   outliers.
3. All parameters, the delay and a drift included, are refined together by Gauss-Newton steps on
   rotation and position errors, each divided by its own spread, with Tukey's weights. The normal
   matrix gives the uncertainties, with fewer independent samples than there are where errors repeat
   themselves.

Source: Zhuang, Roth, Sudhakar (1994), "Simultaneous robot/world and tool/flange calibration by
solving homogeneous transformation equations of the form AX = YB", IEEE Trans. Robotics and
Automation 10:549-554; weights: Beaton and Tukey (1974).
"""

from dataclasses import replace

import numpy as np

from app.science.alignment.delay import LONGEST_DELAY_S, estimate_delay
from app.science.alignment.looking import looking_around
from app.science.alignment.poses import (
    AlignmentError,
    PoseStream,
    mean_rotation,
    reweighted,
)
from app.science.alignment.refinement import Pairs, Unknowns, refine
from app.science.alignment.results import Alignment
from app.science.rotations import (
    FloatArray,
    conjugate,
    geodesic_angle,
    matrices,
    multiply,
    rotate,
    to_rotation_vector,
)

_TURN_SPAN_S = 0.4  # long enough for turns far above the noise
_ROUNDS = 4
_SAY = {
    "still": "The head hardly turned: look around, to the left and right, up and down.",
    "turn": "The head turned about one axis only: turn it to the left and right, too.",
    "nod": "The head turned about one axis only: turn it up and down, too.",
}


def fit_alignment(
    headset: PoseStream, tracker: PoseStream, longest_delay_s: float = LONGEST_DELAY_S
) -> Alignment:
    """Fit an alignment to some seconds of looking around.

    Args:
        headset: the head by the headset; 10 s are good, 30 s better.
        tracker: a tracker that is fixed to the head, over the same time.
        longest_delay_s: delays from -longest_delay_s to longest_delay_s are searched.

    Raises:
        AlignmentError: as `problem` says.
    """
    delay_s = estimate_delay(headset, tracker, longest_delay_s).delay_s
    pairs = Pairs.of(headset, tracker, delay_s)
    missing = looking_around(pairs.head_q).missing
    if missing is not None:
        raise AlignmentError(missing, _SAY[missing])
    return refine(pairs, _first_guess(pairs.thinned(), delay_s), free_mount=True)


def refit_alignment(headset: PoseStream, tracker: PoseStream, known: Alignment) -> Alignment:
    """Fit an alignment again, from one that was good before and may have drifted since.

    Raises:
        AlignmentError: as `problem` says.
    """
    pairs = Pairs.of(headset, tracker, known.mount.delay_s)
    missing = looking_around(pairs.head_q).missing
    if missing is not None:
        raise AlignmentError(missing, _SAY[missing])
    return refine(pairs, _first_world(pairs.thinned(), known), free_mount=True)


def refit_world(headset: PoseStream, tracker: PoseStream, known: Alignment) -> Alignment:
    """Fit only the worlds again, as after a recentre, which cannot have moved the tracker.

    Tracker on the head and delay stay. So a second is enough, and nobody has to look around.

    Raises:
        AlignmentError: `short`.
    """
    pairs = Pairs.of(headset, tracker, known.mount.delay_s)
    return refine(pairs, _first_world(pairs.thinned(), known), free_mount=False, mount=known.mount)


def _first_guess(pairs: Pairs, delay_s: float) -> Unknowns:
    """Return rotations by turns over a short time, then positions by linear equations."""
    tracker_m, tracker_q, _ = pairs.tracker.at(pairs.times_s + delay_s)
    mount_q = _mount_rotation(pairs, tracker_q)
    world_q = _world_rotation(pairs, tracker_q, mount_q)
    # head = world_q tracker + y + (world_q tracker_q) x: linear in y and x.
    reached = pairs.head_m - rotate(world_q, tracker_m)
    turned = matrices(multiply(world_q, tracker_q))
    table = np.concatenate((np.broadcast_to(np.eye(3), turned.shape), turned), axis=2)
    solution = np.zeros(6)

    def solve(weights: FloatArray) -> FloatArray:
        root = np.sqrt(weights)[:, np.newaxis]
        left, right = (root[..., np.newaxis] * table).reshape(-1, 6), (root * reached).ravel()
        solution[:] = np.linalg.lstsq(left, right, rcond=None)[0]
        errors_m: FloatArray = np.linalg.norm(reached - table @ solution, axis=1)
        return errors_m

    reweighted(solve, pairs.weights, _ROUNDS, 1e-6)
    return Unknowns(world_q, solution[:3], np.zeros(3), mount_q, solution[3:], delay_s)


def _mount_rotation(pairs: Pairs, tracker_q: FloatArray) -> FloatArray:
    """Return tracker_from_head (4,) by the axes about which both turn over a short time."""
    span = max(1, round(_TURN_SPAN_S / float(np.median(np.diff(pairs.times_s)))))
    weights = np.minimum(pairs.weights[span:], pairs.weights[:-span])
    head, tracker = (
        to_rotation_vector(multiply(conjugate(q[:-span]), q[span:]))
        for q in (pairs.head_q, tracker_q)
    )
    from scipy.spatial.transform import Rotation  # slow to load

    found = np.zeros(4)

    def solve(weights: FloatArray) -> FloatArray:
        best, _ = Rotation.align_vectors(tracker, head, weights)
        found[:] = best.as_quat(scalar_first=True)
        errors_rad: FloatArray = np.linalg.norm(tracker - rotate(found, head), axis=1)
        return errors_rad

    reweighted(solve, weights, _ROUNDS, 1e-6)
    return found


def _world_rotation(pairs: Pairs, tracker_q: FloatArray, mount_q: FloatArray) -> FloatArray:
    """Return headset_world_from_tracking_world (4,), the mean over all samples."""
    each = multiply(multiply(pairs.head_q, conjugate(mount_q)), conjugate(tracker_q))
    found = np.zeros(4)

    def solve(weights: FloatArray) -> FloatArray:
        found[:] = mean_rotation(each, weights)
        return geodesic_angle(found, each)

    reweighted(solve, pairs.weights, _ROUNDS, 1e-6)
    return found


def _first_world(pairs: Pairs, known: Alignment) -> Unknowns:
    """Return the known tracker on the head, with the world that fits to it."""
    mount = known.mount
    tracker_m, tracker_q, _ = pairs.tracker.at(pairs.times_s + mount.delay_s)
    world_q = _world_rotation(pairs, tracker_q, mount.rotation)
    head_m = tracker_m + rotate(tracker_q, mount.position_m)
    position_m = np.median((pairs.head_m - rotate(world_q, head_m)), axis=0)
    return replace(Unknowns.of(mount), world_q=world_q, world_m=position_m, drift_m_s=np.zeros(3))
