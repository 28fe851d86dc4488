"""What brings poses of a tracking system into the headset's world, and how good it is."""

from dataclasses import dataclass

from app.science.alignment.looking import Looking
from app.science.rotations import FloatArray, multiply, rotate

REACH_M = 1.6
"""How far a foot is from the head of a standing adult; `uncertainty_m` is for this distance."""


@dataclass(frozen=True)
class Quality:
    """How well an alignment explains the samples from which it was fitted.

    Attributes:
        samples: how many were used.
        outliers: the share of them that was disregarded as wrong.
        residual_m: median distance between the head by the headset and by the tracker.
        residual_p95_m: 95th percentile of the same.
        residual_rad: median angle between both.
        residual_p95_rad: 95th percentile of the same.
        uncertainty_m: standard error of a point 1.6 m from the head, such as a foot, at the end of
            the samples, in the direction in which it is largest. It follows from the residuals:
            what both systems get wrong together is not in it.
        condition: condition number of the equations, after scaling; it is large where the
            movement hardly tells parameters apart.
        looking: how far the head turned.
    """

    samples: int
    outliers: float
    residual_m: float
    residual_p95_m: float
    residual_rad: float
    residual_p95_rad: float
    uncertainty_m: float
    condition: float
    looking: Looking


@dataclass(frozen=True, eq=False)
class Mount:
    """How a tracker sits on the head: it stays the same until somebody moves the tracker.

    Attributes:
        rotation: (4,) tracker_from_head.
        position_m: (3,) the head's origin in the tracker's axes.
        delay_s: what the headset said at time t, the tracker said at t + delay_s.
        delay_uncertainty_s: its standard error.
        uncertainty_rad: standard error of the rotation about the axis for which it is largest.
    """

    rotation: FloatArray
    position_m: FloatArray
    delay_s: float
    delay_uncertainty_s: float
    uncertainty_rad: float


@dataclass(frozen=True, eq=False)
class Alignment:
    """The tracking system's world in the headset's world, and the tracker on the head.

    A point p of the tracking system is, in the headset's world at the headset's time t,

        rotation p + position_m + drift_m_s (t - reference_s).

    Attributes:
        rotation: (4,) headset_world_from_tracking_world.
        position_m: (3,) the tracking world's origin in the headset's world at `reference_s`.
        drift_m_s: (3,) how fast that origin moves; zero where no drift was found.
        reference_s: the middle of the samples, by the headset's clock.
        start_s: first sample of the fit.
        end_s: last sample of the fit.
        mount: the tracker on the head.
        quality: how good the fit is.
    """

    rotation: FloatArray
    position_m: FloatArray
    drift_m_s: FloatArray
    reference_s: float
    start_s: float
    end_s: float
    mount: Mount
    quality: Quality

    def to_headset(
        self, times_s: FloatArray, positions_m: FloatArray, rotations: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Bring samples of any tracker of the system into the headset's world and time.

        Args:
            times_s: (N,) when the tracking system's samples are from, by its own stream's clock.
            positions_m: (N, 3).
            rotations: (N, 4) tracking_world_from_tracker.

        Returns:
            Times of the headset (N,), positions (N, 3) and rotations (N, 4) in its world.
        """
        headset_s = times_s - self.mount.delay_s
        moved = (headset_s - self.reference_s)[:, None] * self.drift_m_s
        positions = rotate(self.rotation, positions_m) + self.position_m + moved
        return headset_s, positions, multiply(self.rotation, rotations)

    def head(
        self, times_s: FloatArray, positions_m: FloatArray, rotations: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return where the head is, positions (N, 3) and rotations (N, 4), by its tracker.

        Takes poses of the tracker in the tracking system that belong to the headset's times (N,).
        """
        head_m = positions_m + rotate(rotations, self.mount.position_m)
        _, positions, turned = self.to_headset(times_s + self.mount.delay_s, head_m, rotations)
        return positions, multiply(turned, self.mount.rotation)
