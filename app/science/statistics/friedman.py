"""Friedman's test: do the levels of one within-subjects factor differ, by ranks?

Each subject's k values are ranked among themselves (equal values share the mean rank). Without an
effect each column's ranks average (k + 1) / 2. With R_j the rank sum of level j over n subjects,

    Q = (k - 1) sum_j (R_j - n (k + 1) / 2)^2 / sum_ij (r_ij - (k + 1) / 2)^2,

which is Friedman's statistic with the usual correction for ties. Kendall's W = Q / (n (k - 1)) runs
from 0 (no agreement between subjects) to 1 (all order the levels in the same way); it includes the
same correction. Only the order within a subject counts: the result is invariant under monotone
transforms of the values.

Assumes that subjects are independent of each other and, without an effect, that every order of a
subject's values is equally likely. The exact p is the share of all arrangements, with these ties,
whose Q is as large; the asymptotic one treats Q as chi-square with k - 1 degrees of freedom, which
at a dozen subjects is inaccurate in either direction.

Friedman 1937, J. Am. Stat. Assoc. 32:675-701; Kendall and Babington Smith 1939, Ann. Math. Stat.
10:275-287.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.special import chdtrc

from app.science.statistics.arrays import complete_blocks, require_ranks, row_midranks
from app.science.statistics.friedman_exact import exact_tail

EXACT_UP_TO = 15
Method = Literal["exact", "asymptotic"]


@dataclass(frozen=True)
class Friedman:
    """The result of Friedman's test of n subjects at k levels; ranks have no unit.

    Attributes:
        statistic: the statistic Q, corrected for ties.
        df: degrees of freedom, k - 1.
        p: the p value, computed by `method`.
        p_asymptotic: the p value from the chi-square distribution, always given in addition.
        kendall_w: effect size, 0 to 1, corrected for ties.
        method: "exact" (permutation distribution with these ties) or "asymptotic".
        note: the reason why p is not exact; empty if it is.
        n: number of subjects.
        mean_ranks: the mean rank of each level, 1 to k.
    """

    statistic: float
    df: int
    p: float
    p_asymptotic: float
    kendall_w: float
    method: Method
    note: str
    n: int
    mean_ranks: tuple[float, ...]


def friedman(blocks: npt.ArrayLike, *, exact_up_to: int = EXACT_UP_TO) -> Friedman:
    """Run Friedman's test on complete blocks (n subjects, k levels).

    Subjects with missing values must be left out beforehand (listwise).

    Args:
        blocks: one row per subject, one column per level; any unit.
        exact_up_to: the largest number of subjects for which p is exact. The distribution is
            enumerated for up to 4 levels at 15 subjects, and for 5 at 12 (fewer with ties); beyond,
            p is asymptotic and `note` says so.

    Raises ConstantData if every subject has equal values at all levels, TooFewData,
    StatisticsError.
    """
    values = complete_blocks(blocks)
    n, k = values.shape
    ranks = row_midranks(values)
    require_ranks(ranks)
    within = float(np.square(ranks - 0.5 * (k + 1)).sum())
    sums = ranks.sum(axis=0)
    statistic = (k - 1) * float(np.square(sums - 0.5 * n * (k + 1)).sum()) / within
    asymptotic = float(chdtrc(k - 1, statistic))
    p, note = _exact_p(ranks, exact_up_to)
    return Friedman(
        statistic=statistic,
        df=k - 1,
        p=asymptotic if p is None else p,
        p_asymptotic=asymptotic,
        kendall_w=statistic / (n * (k - 1)),
        method="asymptotic" if p is None else "exact",
        note=note,
        n=n,
        mean_ranks=tuple((sums / n).tolist()),
    )


def _exact_p(ranks: npt.NDArray[np.float64], exact_up_to: int) -> tuple[float | None, str]:
    n, k = ranks.shape
    if n > exact_up_to:
        return None, f"asymptotic: {n} subjects are more than the {exact_up_to} of the exact test"
    p = exact_tail(ranks)
    if p is None:
        return (
            None,
            f"asymptotic: {k} levels of {n} subjects have too many arrangements to list",
        )
    return p, ""
