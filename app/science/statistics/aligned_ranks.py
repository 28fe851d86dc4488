"""The aligned rank transform: an analysis of variance on ranks, one effect at a time.

For each effect, every other effect is first removed from the values ("aligned"): the residual from
the cell means plus the estimate of this one effect. The aligned values are ranked over the whole
table, and an analysis of variance of those ranks is computed, of which only this effect is used.
Wobbrock, Findlater, Gergle and Higgins 2011, CHI, 143-146; ARTool for R is the reference.

**Contested.** With skewed or ordinal values, unequal variances, or other effects present, it
rejects true null hypotheses more often than the nominal level: Luepsen 2017 and 2018; Tsandilas and
Casiez, The illusory promise of the aligned rank transform, Journal of Visualization and
Interaction. Every result here includes that as `caution`. It is offered because reviewers ask for
it; it is never the primary analysis.
"""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from itertools import chain, combinations

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray, complete_blocks, midranks
from app.science.statistics.effects import Effect
from app.science.statistics.rm_anova import checked_cells, rm_anova
from app.science.statistics.split_plot import group_numbers, split_plot_anova

CAUTION = (
    "contested: the aligned rank transform can reject too often with ordinal or skewed values,"
    " unequal variances or other effects (Luepsen 2017, 2018; Tsandilas and Casiez)"
)
_DIGITS = 10


@dataclass(frozen=True)
class AlignedRanks:
    """Effects tested on aligned ranks; sums of squares are of ranks.

    Attributes:
        effects: main effects first; each from its own ranks.
        n: number of subjects.
        caution: the objection to the method; to be shown with every number.
    """

    effects: tuple[Effect, ...]
    n: int
    caution: str = CAUTION


def aligned_ranks_within(
    values: npt.ArrayLike, factors: Sequence[str] = ("A", "B", "C")
) -> AlignedRanks:
    """Test complete values of (n, a) or (n, a, b), all factors within subjects.

    Each effect has its own error (its interaction with subjects), as in ARTool with `Error(subject
    / (A * B))`; with one factor `(1 | subject)` gives the same. Raises the same errors as
    `rm_anova`.
    """
    cells = checked_cells(values)
    axes = range(1, cells.ndim)
    every = list(chain.from_iterable(combinations(axes, size) for size in range(1, cells.ndim)))
    means = np.broadcast_to(cells.mean(axis=0), cells.shape)
    effects = []
    for place, chosen in enumerate(every):
        ranks = _ranked(cells - means + _estimate(means, chosen), cells)
        effects.append(rm_anova(ranks, factors).effects[place])
    return AlignedRanks(tuple(effects), cells.shape[0])


def aligned_ranks_split_plot(
    values: npt.ArrayLike,
    groups: Sequence[Hashable],
    *,
    between: str = "between",
    within: str = "within",
) -> AlignedRanks:
    """Test complete values (n subjects, k levels) of subjects in groups.

    The alignment weights all groups equally. Returns between, within, interaction. Raises the same
    errors as `split_plot_anova`.
    """
    blocks = complete_blocks(values)
    member = group_numbers(groups, blocks.shape[0])
    means = np.stack([blocks[member == group].mean(axis=0) for group in range(member.max() + 1)])
    effects = []
    for place, chosen in enumerate(((0,), (1,), (0, 1))):
        estimate = _estimate(means, chosen)
        ranks = _ranked(blocks - means[member] + estimate[member], blocks)
        tested = split_plot_anova(ranks, groups, between=between, within=within)
        effects.append((tested.between, tested.within, tested.interaction)[place])
    return AlignedRanks(tuple(effects), blocks.shape[0])


def aligned_for(cells: FloatArray, joint: tuple[int, ...]) -> FloatArray:
    """Return ranks aligned for the joint factor of the given axes (ART-C), all within subjects.

    The joint effect of these factors remains: their main effects and interactions.
    """
    means = np.broadcast_to(cells.mean(axis=0), cells.shape)
    others = tuple(axis for axis in range(cells.ndim) if axis not in joint)
    joint_effect = means.mean(axis=others, keepdims=True) - means.mean()
    return _ranked(cells - means + joint_effect, cells)


def _estimate(means: FloatArray, chosen: tuple[int, ...]) -> FloatArray:
    """Estimate the effect of the chosen axes in each cell, by inclusion and exclusion."""
    axes = set(range(means.ndim))
    total = np.zeros_like(means)
    for size in range(len(chosen) + 1):
        for subset in combinations(chosen, size):
            others = tuple(axes - set(subset))
            sign = -1.0 if (len(chosen) - size) % 2 else 1.0
            total = total + sign * means.mean(axis=others, keepdims=True)
    return total


def _ranked(aligned: FloatArray, values: FloatArray) -> FloatArray:
    """Rank over the whole table; values that differ only by rounding are tied."""
    scale = float(np.abs(values - values.mean()).max())
    even = np.round(aligned / scale, _DIGITS) if scale > 0.0 else aligned
    return midranks(even.ravel()).reshape(aligned.shape)
