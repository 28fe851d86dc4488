"""The design matrix of the fixed effects: one row per observation, one column per coefficient.

Factors are coded against their reference level, so the coefficient `latency[125]` is the difference
of 125 from the reference where every other factor of an interaction is at its own reference. The
quantity of interest is seldom one coefficient: it is a mean or a difference over cells. Those are
computed from the *grid*, the design's row for every combination of levels, each of equal weight
however many observations it has (marginal means; Searle, Speed and Milliken 1980). A term is tested
by the contrasts of its marginal means, which is the test called type III and does not depend on the
coding.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
import scipy.linalg

from app.science.statistics.arrays import FloatArray, IntArray
from app.science.statistics.mixed.terms import Covariate, Factor, ModelError

INTERCEPT = "intercept"
_DEPENDENT = 1e-9


@dataclass(frozen=True, eq=False)
class Design:
    """The fixed part of a model.

    Attributes:
        matrix: (N, p) predictors; the first column is the intercept.
        names: the names of the p coefficients.
        factors: the factors in the order of the grid's axes, the last varying fastest.
        covariates: the covariates, each a term of its own, without interactions.
        interactions: the products of factors, by name.
    """

    matrix: FloatArray
    names: tuple[str, ...]
    factors: tuple[Factor, ...]
    covariates: tuple[Covariate, ...]
    interactions: tuple[tuple[str, ...], ...]

    @property
    def terms(self) -> tuple[str, ...]:
        """The terms that can be tested: `latency`, `limb`, `latency:limb`, and each covariate."""
        mains = [*(each.name for each in self.factors), *(each.name for each in self.covariates)]
        return (*mains, *(":".join(names) for names in self.interactions))

    def factor(self, name: str) -> Factor:
        """Return the factor of that name; if unknown, raise ModelError listing the factors."""
        for each in self.factors:
            if each.name == name:
                return each
        valid = ", ".join(each.name for each in self.factors)
        raise ModelError(f"There is no factor {name} in the model; valid: {valid}.")


def build_design(
    factors: Sequence[Factor],
    covariates: Sequence[Covariate] = (),
    interactions: Sequence[tuple[str, ...]] = (),
) -> Design:
    """Return the design of the given terms.

    Args:
        factors: main effects; may be empty if there is a covariate.
        covariates: further columns.
        interactions: tuples of factors' names, for instance `(("latency", "limb"),)`.

    Raises:
        ModelError: lengths differ, a name is unknown or used twice, or a column is a linear
            combination of the others, so that its coefficient cannot be estimated.
    """
    _check_names(factors, covariates)
    lengths = {len(each.codes) for each in factors} | {len(each.columns) for each in covariates}
    if len(lengths) != 1:
        raise ModelError(f"Every term needs one value per observation; lengths are {lengths}.")
    found = Design(
        np.empty((0, 0)), (), tuple(factors), tuple(covariates), tuple(map(tuple, interactions))
    )
    matrix, names = _columns(found, [each.codes for each in factors], lengths.pop())
    numbers = [each.columns for each in covariates]
    names += [_part(each.name, part) for each in covariates for part in each.parts]
    matrix = np.hstack([matrix, *numbers])
    _check_independence(matrix, names)
    return Design(matrix, tuple(names), found.factors, found.covariates, found.interactions)


def cells(design: Design) -> tuple[tuple[int, ...], ...]:
    """Return every combination of levels, as indices in the order of the factors."""
    return tuple(product(*(range(len(each.levels)) for each in design.factors)))


def grid(design: Design) -> FloatArray:
    """Return the design's row of each cell, (cells, p), with covariates held constant."""
    combinations = cells(design)
    codes = np.array(combinations, dtype=np.int64).reshape(len(combinations), -1)
    matrix, _ = _columns(design, list(codes.T), len(combinations))
    held = [value for each in design.covariates for value in each.held_at]
    return np.hstack([matrix, np.tile(held, (len(combinations), 1))])


def term_contrasts(design: Design, term: str) -> FloatArray:
    """Return contrasts (r, p) of the coefficients that are all zero if the term has no effect.

    They are zero only in that case.

    Raises:
        ModelError: there is no such term.
    """
    if term not in design.terms:
        raise ModelError(f"There is no term {term}; valid: {', '.join(design.terms)}.")
    for each in design.covariates:
        if each.name == term:
            columns = [_part(each.name, part) for part in each.parts]
            return np.eye(len(design.names))[[design.names.index(name) for name in columns]]
    factors = term.split(":")
    weights = [
        _differences(len(each.levels)) if each.name in factors else _average(len(each.levels))
        for each in design.factors
    ]
    joint: FloatArray = np.ones((1, 1))
    for weight in weights:
        joint = np.asarray(np.kron(joint, weight), dtype=np.float64)
    return joint @ grid(design)


def marginal_weights(design: Design, factor: str, by: str = "") -> dict[str, dict[str, FloatArray]]:
    """Return the weights of marginal means: by level of `by`, then by level of `factor`.

    Without `by`, its only level is an empty name.

    Raises:
        ModelError: there is no such factor.
    """
    names = [each.name for each in design.factors]
    rows, places = grid(design), np.array(cells(design))
    compared, within = design.factor(factor), {"": np.full(len(rows), True)}
    if by:
        other = design.factor(by)
        column = places[:, names.index(by)]
        within = {level: column == code for code, level in enumerate(other.levels)}
    at = places[:, names.index(factor)]
    return {
        label: {
            level: np.asarray(rows[chosen & (at == code)].mean(axis=0), dtype=np.float64)
            for code, level in enumerate(compared.levels)
        }
        for label, chosen in within.items()
    }


def pairs_of(design: Design, factor: str, against: str = "") -> list[tuple[str, str]]:
    """Return all pairs of the factor's levels, or each other level paired with `against`.

    Raises:
        ModelError: there is no such factor or level.
    """
    levels = design.factor(factor).levels
    if not against:
        return list(combinations(levels, 2))
    if against not in levels:
        raise ModelError(f"{factor} has no level {against}; valid: {', '.join(levels)}.")
    return [(level, against) for level in levels if level != against]


def _differences(levels: int) -> FloatArray:
    return np.hstack([-np.ones((levels - 1, 1)), np.eye(levels - 1)])


def _average(levels: int) -> FloatArray:
    return np.full((1, levels), 1.0 / levels)


def _columns(design: Design, codes: list[IntArray], rows: int) -> tuple[FloatArray, list[str]]:
    """Return intercept, main effects and interactions for the given codes of each factor."""
    named = {each.name: (each, code) for each, code in zip(design.factors, codes, strict=True)}
    columns, names = [np.ones((rows, 1))], [INTERCEPT]
    for term in (*((each.name,) for each in design.factors), *design.interactions):
        unknown = [name for name in term if name not in named]
        if unknown:
            raise ModelError(f"{unknown[0]} is not a factor; valid: {', '.join(named)}.")
        block, labels = np.ones((rows, 1)), [""]
        for name in term:
            factor, code = named[name]
            indicators = np.eye(len(factor.levels))[code][:, 1:]
            block = (block[:, :, np.newaxis] * indicators[:, np.newaxis, :]).reshape(rows, -1)
            parts = [_part(name, level) for level in factor.levels[1:]]
            labels = [f"{left}:{part}".lstrip(":") for left in labels for part in parts]
        columns.append(block)
        names += labels
    return np.hstack(columns), names


def _part(name: str, part: str) -> str:
    return f"{name}[{part}]" if part else name


def _check_names(factors: Sequence[Factor], covariates: Sequence[Covariate]) -> None:
    names = [*(each.name for each in factors), *(each.name for each in covariates)]
    if not names or len(set(names)) < len(names):
        raise ModelError(f"The terms of a model need distinct names; given: {names}.")


def _check_independence(matrix: FloatArray, names: list[str]) -> None:
    lengths = np.linalg.norm(matrix, axis=0)
    scaled = matrix / np.where(lengths > 0.0, lengths, 1.0)
    triangle, order = scipy.linalg.qr(scaled, mode="r", pivoting=True)
    size = np.abs(np.diag(triangle))
    if len(size) < len(names):
        raise ModelError(f"{len(matrix)} observations are too few for {len(names)} coefficients.")
    lost = [names[at] for at, left in zip(order, size, strict=False) if left < _DEPENDENT]
    if lost:
        raise ModelError(
            f"{', '.join(sorted(lost))} cannot be estimated: in these observations their columns "
            "are linear combinations of the others. Leave a term out."
        )
