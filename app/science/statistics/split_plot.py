"""Analysis of variance with one factor between subjects and one within (split-plot).

Each subject belongs to one group and is measured at every level of the within factor. The groups
are tested against the subjects within groups; the within factor and its interaction with the groups
against its interaction with subjects within groups, pooled over groups, with Greenhouse and
Geisser's epsilon of the pooled covariance. Groups may differ in size: every group then has equal
weight in the mean of the within factor (type III).

Kirk 2013, Experimental Design, chapter 12; Maxwell, Delaney and Kelley 2018, chapter 14.
"""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray, complete_blocks
from app.science.statistics.effects import Effect, Part, contrasts, tested_effect
from app.science.statistics.errors import StatisticsError, TooFewData


@dataclass(frozen=True)
class SplitPlot:
    """The effects between, within and their interaction; n subjects in groups of these sizes."""

    between: Effect
    within: Effect
    interaction: Effect
    n: int
    group_sizes: tuple[int, ...]


def split_plot_anova(
    values: npt.ArrayLike,
    groups: Sequence[Hashable],
    *,
    between: str = "between",
    within: str = "within",
) -> SplitPlot:
    """Test complete values (n subjects, k levels) of subjects in groups.

    Args:
        values: the values in the unit of the measure.
        groups: (n,) the group of each subject.
        between, within: names of the two factors.

    Raises TooFewData for fewer than two groups or two subjects in one, ConstantData without error.
    """
    blocks = complete_blocks(values)
    member = group_numbers(groups, blocks.shape[0])
    subjects = blocks.shape[1] ** 0.5 * blocks.mean(axis=1, keepdims=True)
    parts = (
        _between(subjects, member, between, within_subject=False),
        _mean(blocks @ contrasts(blocks.shape[1]), member, within),
        _between(
            blocks @ contrasts(blocks.shape[1]), member, f"{between}:{within}", within_subject=True
        ),
    )
    spread = parts[0].ss_error + parts[1].ss_error
    first, second, third = (tested_effect(part, spread) for part in parts)
    sizes = tuple(np.bincount(member).tolist())
    return SplitPlot(first, second, third, blocks.shape[0], sizes)


def group_numbers(groups: Sequence[Hashable], n: int) -> npt.NDArray[np.intp]:
    """Number the groups 0, 1, ... as they first appear.

    Raises the same errors as `split_plot_anova`.
    """
    if len(groups) != n:
        raise StatisticsError(f"{len(groups)} groups were given for {n} subjects; give one each.")
    numbers: dict[Hashable, int] = {}
    member = np.array([numbers.setdefault(group, len(numbers)) for group in groups], dtype=np.intp)
    sizes = np.bincount(member)
    if len(numbers) < 2 or sizes.min() < 2:
        listed = ", ".join(f"{name} {size}" for name, size in zip(numbers, sizes, strict=True))
        raise TooFewData(f"Subjects per group: {listed}; at least two groups of two are needed.")
    return member


def _scatter(scores: FloatArray, member: npt.NDArray[np.intp]) -> tuple[FloatArray, FloatArray]:
    """Return the group means (g, d) and the pooled scatter (d, d) about them."""
    sizes = np.bincount(member)
    means = np.zeros((sizes.size, scores.shape[1]))
    np.add.at(means, member, scores)
    means /= sizes[:, np.newaxis]
    about = scores - means[member]
    return means, about.T @ about


def _between(
    scores: FloatArray, member: npt.NDArray[np.intp], name: str, *, within_subject: bool
) -> Part:
    """Return the effect of the groups on the scores."""
    means, scatter = _scatter(scores, member)
    sizes = np.bincount(member)
    off = means - np.average(means, axis=0, weights=sizes)
    d, freedom = scores.shape[1], scores.shape[0] - sizes.size
    return Part(
        name=name,
        ss=float(sizes @ np.square(off).sum(axis=1)),
        ss_error=float(np.trace(scatter)),
        df=d * (sizes.size - 1),
        df_error=d * freedom,
        covariance=scatter / freedom,
        within=within_subject,
    )


def _mean(scores: FloatArray, member: npt.NDArray[np.intp], name: str) -> Part:
    """Return the effect that tests whether the scores, groups weighted equally, have mean zero."""
    means, scatter = _scatter(scores, member)
    sizes = np.bincount(member)
    mean = means.mean(axis=0)
    weight = sizes.size**2 / float((1.0 / sizes).sum())
    d, freedom = scores.shape[1], scores.shape[0] - sizes.size
    return Part(
        name=name,
        ss=weight * float(mean @ mean),
        ss_error=float(np.trace(scatter)),
        df=d,
        df_error=d * freedom,
        covariance=scatter / freedom,
    )
