"""The one line out of a band that is told as the offset.

Half the round trip is the best guess for each way, and the better the shorter the round trip was:
what a probe lost in queues it mostly lost on one way. So the lines' middle is a least-squares fit
to the probes' offsets with weights that fall with the time in queues,

    sigma_i = slack + (round_trip_i - shortest) / 2,

and the drift is held by its limit where the probes are too few to tell (a Gaussian prior with that
standard deviation). The line is then brought into the band, which no true clock leaves.
"""

import numpy as np

from app.science.clock.band import Band
from app.science.clock.limits import ClockLimits
from app.science.clock.probes import ClockProbes


def best_line(probes: ClockProbes, band: Band, limits: ClockLimits) -> tuple[float, float]:
    """Offset at `band.ref_s` in s and drift in s/s."""
    t_s = probes.middle_s - band.ref_s
    offset_s = probes.offset_s - band.offset_s
    round_trip_s = probes.round_trip_s
    sigma_s = limits.slack_s + 0.5 * (round_trip_s - round_trip_s.min())
    weight = sigma_s**-2
    centre_s = np.average(t_s, weights=weight)
    mean_s = np.average(offset_s, weights=weight)
    spread = np.sum(weight * (t_s - centre_s) ** 2) + limits.drift**-2
    drift = float(np.sum(weight * (t_s - centre_s) * (offset_s - mean_s)) / spread)
    a_s, drift = band.nearest(float(mean_s - drift * centre_s), drift)
    return band.offset_s + a_s, drift
