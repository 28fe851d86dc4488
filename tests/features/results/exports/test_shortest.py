"""Tests of printing single-precision numbers with as few digits as possible."""

import numpy as np
import pytest
from numpy.typing import NDArray

from app.features.results.exports.writing.samples import shortest_doubles


def _any_singles(count: int) -> NDArray[np.float32]:
    bits = np.random.default_rng(7).integers(0, 2**32, count, dtype=np.uint32)
    return bits.view(np.float32)


def test_the_text_reads_back_as_the_same_single() -> None:
    """The text of any finite single reads back as the same bits."""
    values = _any_singles(50_000)
    values = values[np.isfinite(values)]
    texts = [repr(double) for double in shortest_doubles(values).tolist()]
    back = np.array([float(text) for text in texts]).astype(np.float32)
    assert (back.view(np.uint32) == values.view(np.uint32)).all()


@pytest.mark.parametrize("scale", [1.0, 1e-4, 3e4, 1e-13, 1e-20, 1e-36])
def test_the_text_is_the_shortest(scale: float) -> None:
    """The text of a single is as short as numpy's shortest (Dragon4)."""
    values = np.random.default_rng(1).normal(scale=scale, size=5000).astype(np.float32)
    ours = shortest_doubles(values).tolist()
    assert ours == [float(str(value)) for value in values]


def test_powers_have_their_shortest_text() -> None:
    """Powers of two, whose neighbours are not equally far away, and of ten are the shortest too."""
    powers = [*(2.0 ** np.arange(-149, 128)), *(10.0 ** np.arange(-45, 39))]
    values = np.array(powers, np.float32)
    assert shortest_doubles(values).tolist() == [float(str(value)) for value in values]


def test_known_numbers_have_their_shortest_text() -> None:
    """0.1 in single precision is written 0.1, not 0.10000000149011612."""
    values = np.array([0.1, 0.0, -0.0, 1.0, 16777216.0, 1e-45, -0.70710677], np.float32)
    texts = [repr(double) for double in shortest_doubles(values).tolist()]
    assert texts == ["0.1", "0.0", "-0.0", "1.0", "16777216.0", "1e-45", "-0.70710677"]


def test_nan_and_infinities_are_unchanged() -> None:
    """NaN and infinities are written as `nan`, `inf` and `-inf`."""
    values = np.array([np.nan, np.inf, -np.inf], np.float32)
    assert [repr(double) for double in shortest_doubles(values).tolist()] == ["nan", "inf", "-inf"]
