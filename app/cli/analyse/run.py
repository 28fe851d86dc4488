"""Run `reembody analyse`: apply all usual tests to a tidy table."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from app.cli.analyse.doubts import (
    contradicted_orders,
    doubtful_means,
    missing_codes,
    mistyped_levels,
    nearly_asked_for,
    split_decimals,
    unused_codes,
)
from app.cli.analyse.families import Family, families_of, mean_interval, tried
from app.cli.analyse.inputs import TidyInput, read_tidy
from app.cli.analyse.people import alike_subjects, same_people, summary_rows
from app.science.statistics import (
    AlignedRanks,
    Cells,
    Complete,
    ConstantData,
    MeanInterval,
    RmAnova,
    StatisticsError,
    TooFewData,
    aligned_ranks_within,
    cells_of,
    complete_rows,
    has_order,
    rm_anova,
)

_MOST_FACTORS = 2
_SHOWN = 8


@dataclass(frozen=True)
class AnalyseOrder:
    """The options of the command `analyse`."""

    table: Path
    subject: str
    within: list[str]
    measure: str
    reference: str | None
    art: bool
    where: tuple[str, ...] = ()
    """Conditions COLUMN=VALUE that a row must fulfil."""
    declared_orders: tuple[str, ...] = ()
    """FACTOR=LEVEL,LEVEL,...: the declared order of a factor's levels."""
    averaged: tuple[str, ...] = ()
    """Columns of words that tell the rows of a cell apart, and may be averaged over."""
    missing: tuple[str, ...] = ()
    """Values of the measure that stand for a missing one."""


@dataclass(frozen=True)
class CellMean:
    """One cell: its levels by factor, and statistics over the subjects that have a value in it."""

    levels: dict[str, str]
    n: int
    sd: float
    median: float
    interval: MeanInterval | None
    mean: float


@dataclass(frozen=True)
class Analysis:
    """All results of an analysis, and which subjects were left out."""

    order: AnalyseOrder
    cells: Cells
    complete: Complete
    means: tuple[CellMean, ...]
    families: tuple[Family, ...]
    rm_anova: RmAnova | None
    aligned: AlignedRanks | None
    rows_used: int
    rows_left_out: dict[str, int]
    """How many rows of the file were left out, by reason."""
    averaged_over: tuple[str, ...] = ()
    """Columns that tell the values of each cell apart, whose mean was taken."""
    read_as: tuple[str, ...] = ()
    """Sentences on columns whose decimal sign is not the point."""
    alike: tuple[str, ...] = ()
    """The warnings about names, levels and numbers that may be mistaken, which come first."""
    warnings: list[str] = field(default_factory=list)


def carry_out(order: AnalyseOrder) -> Analysis:
    """Analyse a file.

    Raises StatisticsError (a ValueError) if the data cannot be analysed, OSError if the file cannot
    be read.
    """
    if not 1 <= len(order.within) <= _MOST_FACTORS:
        raise StatisticsError(
            f"{len(order.within)} within-subject factors were named; one or two can be analysed."
        )
    orders = _orders(order)
    read = read_tidy(
        order.table,
        order.subject,
        order.within,
        order.measure,
        order.where,
        order.averaged,
        order.missing,
    )
    cells = cells_of(
        read.subjects,
        read.within,
        read.measure,
        measure_name=order.measure,
        subject_name=order.subject,
        lines=read.lines,
        orders=orders,
    )
    complete = cells.complete()
    alike = (
        alike_subjects(read, order.subject)
        + [text for factor in cells.factors for text in mistyped_levels(factor, read)]
        + summary_rows(read, order.subject)
        + same_people(cells, order.subject)
        + list(read.doubtful_numbers)
        + split_decimals(order.measure, read)
    )
    _check_usable(order, cells, complete, alike)
    left_out = read.left_out | ({f"no {order.measure}": cells.n_empty} if cells.n_empty else {})
    warnings = (
        alike + nearly_asked_for(read) + doubtful_means(read) + _warnings(cells, complete, read)
    )
    warnings += missing_codes(order.measure, read) + unused_codes(order.measure, read)
    warnings += contradicted_orders(cells, orders)
    warnings += [
        f"{count} rows have {reason} and were left out"
        for reason, count in read.left_out.items()
        if reason not in order.where
    ]
    ordered = frozenset(
        factor
        for factor, levels in zip(cells.factors, cells.levels, strict=True)
        if factor in orders or has_order(levels)
    )
    return Analysis(
        order=order,
        cells=cells,
        complete=complete,
        means=tuple(_means(cells)),
        families=tuple(families_of(cells, order.reference, ordered, warnings)),
        rm_anova=tried(lambda: rm_anova(complete.values, cells.factors), warnings),
        aligned=tried(lambda: aligned_ranks_within(complete.values, cells.factors), warnings)
        if order.art
        else None,
        rows_used=int(cells.rows.sum()),
        rows_left_out=left_out,
        averaged_over=read.told_apart_by,
        read_as=read.read_as,
        alike=tuple(alike),
        warnings=warnings,
    )


def _orders(order: AnalyseOrder) -> dict[str, list[str]]:
    """Return the declared orders by factor."""
    found: dict[str, list[str]] = {}
    for text in order.declared_orders:
        factor, equals, listed = (part.strip() for part in text.partition("="))
        if not equals or factor not in order.within:
            raise StatisticsError(
                f"{text!r} is not an order of a factor; write FACTOR=LEVEL,LEVEL,... for one of:"
                f" {', '.join(order.within)}."
            )
        found[factor] = [level.strip() for level in listed.split(",")]
    return found


def missing_cells(cells: Cells, subject: str) -> str:
    """Describe the cells in which a subject has no value."""
    row = cells.rows[cells.subjects.index(subject)]
    lacking = [
        ", ".join(
            f"{factor} {levels[place]}"
            for factor, levels, place in zip(cells.factors, cells.levels, where, strict=True)
        )
        for where in np.argwhere(row == 0)
    ]
    more = f" and {len(lacking) - _SHOWN} more" if len(lacking) > _SHOWN else ""
    return "; ".join(lacking[:_SHOWN]) + more


def _check_usable(
    order: AnalyseOrder, cells: Cells, complete: Complete, doubts: Sequence[str]
) -> None:
    if len(complete.subjects) < 2:
        lacking = complete.left_out[0]
        few = (
            f"only {len(complete.subjects)} of {len(cells.subjects)} subjects have a value of"
            f" {order.measure!r} in every cell; two at least are needed."
        )
        if doubts:
            raise TooFewData("".join(f"{text}. " for text in doubts) + f"As it is, {few}")
        raise TooFewData(
            f"O{few[1:]} {order.subject} {lacking!r}, for example, lacks"
            f" {missing_cells(cells, lacking)}."
        )
    if float(np.ptp(complete.values)) <= 0.0:
        raise ConstantData(
            f"Column {order.measure!r} is {complete.values.flat[0]:g} in every cell of every"
            " complete subject; there is nothing to test."
        )


def _warnings(cells: Cells, complete: Complete, read: TidyInput) -> list[str]:
    warnings = [
        f"left out of Friedman, Page and ANOVA (listwise): {name} lacks"
        f" {missing_cells(cells, name)}"
        for name in complete.left_out
    ]
    if cells.n_averaged:
        warnings.append(
            f"{cells.n_averaged} of {cells.rows.size} cells have several values, at most"
            f" {int(cells.rows.max())}; their mean was taken"
            + (f", over {', '.join(read.told_apart_by)}" if read.told_apart_by else "")
        )
    if read.replicates:
        warnings.append(
            f"{read.replicates} rows duplicate an earlier one; they count as replicates"
        )
    return warnings


def _means(cells: Cells) -> list[CellMean]:
    found = []
    for where in np.ndindex(*cells.values.shape[1:]):
        levels = {
            factor: names[place]
            for factor, names, place in zip(cells.factors, cells.levels, where, strict=True)
        }
        column, _ = complete_rows(cells.values[(slice(None), *where)])
        found.append(
            CellMean(
                levels=levels,
                n=column.size,
                mean=float(column.mean()) if column.size else float("nan"),
                sd=float(column.std(ddof=1)) if column.size > 1 else float("nan"),
                median=float(np.median(column)) if column.size else float("nan"),
                interval=mean_interval(column),
            )
        )
    return found
