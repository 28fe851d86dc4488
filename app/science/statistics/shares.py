"""Scores and contact times as shares of a whole.

Each component of embodiment has its own range (ownership -15 to 15, agency -12 to 12, location -9
to 9): as shares of their maxima components can be compared. For contact times, the shares are those
of finger, hand and arm in the time of contact. A share of independent trials has an exact interval.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import betaincinv

from app.science.statistics.arrays import FloatArray
from app.science.statistics.errors import StatisticsError


def share_of_maximum(scores: npt.ArrayLike, maximum: float) -> FloatArray:
    """Return scores as shares of the largest possible score, -1 to 1; NaN stays NaN.

    0 is the middle of the scale, so a share is not a percentage of answers.

    Raises StatisticsError for a maximum that is not positive, or a score beyond it.
    """
    values = np.asarray(scores, dtype=np.float64)
    if not (np.isfinite(maximum) and maximum > 0.0):
        raise StatisticsError(f"The maximum is {maximum}; it must be positive.")
    if values.size and not np.all(np.isnan(values) | (np.abs(values) <= maximum)):
        worst = float(values.flat[np.nanargmax(np.abs(values))])
        raise StatisticsError(
            f"A score of {worst} is beyond the maximum of {maximum}; check which score this is."
        )
    return values / maximum


@dataclass(frozen=True)
class ContactShares:
    """The division of each subject's contact time among groups of body parts.

    Attributes:
        groups: names, in the given order.
        shares: (n, groups) shares, of which each row adds up to 1; NaN for subjects without any
            contact.
        total_s: (n,) the summed time of all parts. Parts can touch simultaneously, so this is not
            the duration of contact, which would be the union of the intervals.
        n_without_contact: subjects without any contact.
    """

    groups: tuple[str, ...]
    shares: FloatArray
    total_s: FloatArray
    n_without_contact: int


def contact_shares(
    times_s: Mapping[str, npt.ArrayLike], group_of: Mapping[str, str]
) -> ContactShares:
    """Divide the contact times of body parts among their groups (finger, hand, arm).

    Args:
        times_s: for each part the contact time of n subjects, s; 0 if it never touched.
        group_of: the group of each part; groups appear in the order of this table.

    Raises StatisticsError if there is no part, a part has no group, a time is negative or missing,
    or the columns differ in length.
    """
    if not times_s:
        raise StatisticsError("No body part was given; give the times of at least one.")
    ungrouped = [part for part in times_s if part not in group_of]
    if ungrouped:
        raise StatisticsError(f"No group was given for {', '.join(ungrouped)}.")
    columns = {part: np.asarray(times, dtype=np.float64) for part, times in times_s.items()}
    if len({column.shape for column in columns.values()}) != 1:
        raise StatisticsError("The parts have times of different numbers of subjects.")
    for part, column in columns.items():
        if column.ndim != 1 or not np.all(np.isfinite(column) & (column >= 0.0)):
            raise StatisticsError(f"{part}: give one time of 0 s or more for each subject.")
    groups = tuple(dict.fromkeys(group_of[part] for part in group_of if part in columns))
    sums = np.stack(
        [
            sum((columns[part] for part in columns if group_of[part] == group), np.float64(0.0))
            for group in groups
        ],
        axis=1,
    )
    total = sums.sum(axis=1)
    shares = np.full_like(sums, np.nan)
    np.divide(sums, total[:, np.newaxis], out=shares, where=total[:, np.newaxis] > 0.0)
    return ContactShares(groups, shares, total, int((total <= 0.0).sum()))


def clopper_pearson(
    successes: int, trials: int, *, confidence: float = 0.95
) -> tuple[float, float]:
    """Return the Clopper-Pearson interval of a probability, 0 to 1.

    It covers the probability at least as often as it says, whatever the probability is: its ends
    are quantiles of the beta distributions with (x, m - x + 1) and (x + 1, m - x).
    Clopper and Pearson 1934, Biometrika 26:404-413.

    Raises:
        StatisticsError: no trials, or successes outside 0 to `trials`, or a confidence outside
            0 to 1.
    """
    if trials < 1 or not 0 <= successes <= trials:
        raise StatisticsError(f"{successes} of {trials} is no proportion.")
    if not 0.0 < confidence < 1.0:
        raise StatisticsError(f"The confidence is {confidence}; give a number between 0 and 1.")
    tail = (1.0 - confidence) / 2.0
    failures = trials - successes
    low = float(betaincinv(successes, failures + 1, tail)) if successes else 0.0
    high = float(betaincinv(successes + 1, failures, 1.0 - tail)) if failures else 1.0
    return low, high
