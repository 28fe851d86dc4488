"""Travel times with effects of people: curves of path length, learnt and drawn from.

`posterior_of` learns a `Curve` from `TimedWalks`; the `Posterior` draws travel times of somebody
new. `StartingAndStopping` is our curve, `BASELINES` are those with which it is compared.
"""

from app.science.walking.travel_times.curves import (
    BASELINES,
    ConstantSpeed,
    Curve,
    Line,
    LogLog,
    StartingAndStopping,
    TimedWalks,
    resting_of,
    turning_of,
)
from app.science.walking.travel_times.mixed_effects import Posterior, posterior_of

__all__ = [
    "BASELINES",
    "ConstantSpeed",
    "Curve",
    "Line",
    "LogLog",
    "Posterior",
    "StartingAndStopping",
    "TimedWalks",
    "posterior_of",
    "resting_of",
    "turning_of",
]
