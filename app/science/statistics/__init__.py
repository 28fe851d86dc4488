"""Statistics for studies with few subjects and repeated measures, on arrays.

    cells_of                            a tidy table as cells; the rules for missing values
    friedman, pairwise, page_trend      ranks of one within-subjects factor, exact where possible
    signed_rank, holm
    rm_anova, split_plot_anova          analysis of variance, sphericity, effect sizes
    aligned_ranks_*, aligned_contrasts  the aligned rank transform, labelled as contested
    cronbach_alpha, mcdonald_omega      reliability of scales
    bootstrap_interval, mean_interval, within_subject_intervals, spearman
    rm_anova_power, subjects_needed     planning
    clopper_pearson                     the interval of a proportion
    against_reference, directional      tests that a study declares beforehand
    share_of_maximum, contact_shares, explore

Every result gives the number of subjects in it and of those left out. Mixed models are in
`statistics.mixed`, which has exports of its own.
"""

from app.science.statistics.aligned_contrasts import aligned_contrasts
from app.science.statistics.aligned_ranks import (
    AlignedRanks,
    aligned_ranks_split_plot,
    aligned_ranks_within,
)
from app.science.statistics.arrays import FloatArray, IntArray, complete_rows
from app.science.statistics.bootstrap import Interval, bootstrap_interval, mean_of, median_of
from app.science.statistics.effects import Effect
from app.science.statistics.error_rates import (
    LEAST_COVERAGE,
    LEVEL,
    MOST_REJECTIONS,
    ErrorRate,
    ErrorRates,
    Kind,
    error_rates_from_json,
)
from app.science.statistics.errors import ConstantData, StatisticsError, TooFewData, UnusableTable
from app.science.statistics.exploring import Explored, explore
from app.science.statistics.friedman import Friedman, friedman
from app.science.statistics.levels import as_number, has_order, ordered_levels, place_of
from app.science.statistics.mean_intervals import (
    MeanInterval,
    mean_interval,
    within_subject_intervals,
)
from app.science.statistics.page import PageTrend, page_trend
from app.science.statistics.pairwise import Comparison, holm, pairwise
from app.science.statistics.planned import (
    AgainstReference,
    Direction,
    DirectionalHypothesis,
    against_reference,
    directional,
)
from app.science.statistics.power import Expected, rm_anova_power, subjects_needed
from app.science.statistics.reliability import cronbach_alpha, mcdonald_omega
from app.science.statistics.rm_anova import RmAnova, rm_anova
from app.science.statistics.shares import clopper_pearson, contact_shares, share_of_maximum
from app.science.statistics.signed_rank import signed_rank
from app.science.statistics.spearman import Spearman, spearman
from app.science.statistics.split_plot import split_plot_anova
from app.science.statistics.tidy import MISSING, Cells, Complete, cells_of

__all__ = [
    "LEAST_COVERAGE",
    "LEVEL",
    "MISSING",
    "MOST_REJECTIONS",
    "AgainstReference",
    "AlignedRanks",
    "Cells",
    "Comparison",
    "Complete",
    "ConstantData",
    "Direction",
    "DirectionalHypothesis",
    "Effect",
    "ErrorRate",
    "ErrorRates",
    "Expected",
    "Explored",
    "FloatArray",
    "Friedman",
    "IntArray",
    "Interval",
    "Kind",
    "MeanInterval",
    "PageTrend",
    "RmAnova",
    "Spearman",
    "StatisticsError",
    "TooFewData",
    "UnusableTable",
    "against_reference",
    "aligned_contrasts",
    "aligned_ranks_split_plot",
    "aligned_ranks_within",
    "as_number",
    "bootstrap_interval",
    "cells_of",
    "clopper_pearson",
    "complete_rows",
    "contact_shares",
    "cronbach_alpha",
    "directional",
    "error_rates_from_json",
    "explore",
    "friedman",
    "has_order",
    "holm",
    "mcdonald_omega",
    "mean_interval",
    "mean_of",
    "median_of",
    "ordered_levels",
    "page_trend",
    "pairwise",
    "place_of",
    "rm_anova",
    "rm_anova_power",
    "share_of_maximum",
    "signed_rank",
    "spearman",
    "split_plot_anova",
    "subjects_needed",
    "within_subject_intervals",
]
