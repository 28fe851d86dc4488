"""Tests that damaged models are read or rejected without a crash, a hang or a warning."""

import contextlib
import json
import warnings
from collections import Counter
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.adapters.humanoids import HumanoidFileError, Limits, read_humanoid
from app.science.avatar.body import HumanoidError, figure_of
from tests.adapters.humanoids.fuzzing import attempt
from tests.adapters.humanoids.fuzzing import damaged as damaged_model
from tests.support.humanoid_files import glb, humanoid_file, taken_apart
from tests.support.humanoid_model import Model, without
from tests.support.repetitions import usually

_LIMITS = Limits(bytes=400_000, vertices=20_000, values=400_000)
_SEEDS = [
    humanoid_file(Model(parts=without("Index", "Ring", "Little"), vrm=1)),
    humanoid_file(Model(parts=without("Index", "Ring", "Little"), vrm=0)),
    humanoid_file(Model(parts=without("Index", "Ring", "Little"))),
]
_ODD: list[Any] = [
    *(0, -1, 1, 2**31, 2**63, 1e308, 1e-320, -0.0, 0.5, 5126, 5121, None, True, "", "x", "NaN"),
    *([], {}, [0], [[]], [1, 2, 3], {"node": 0}),
]


def survives(data: bytes) -> None:
    """Read a file, which may raise only an error about the model, and never a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with contextlib.suppress(HumanoidFileError, HumanoidError):
            figure_of(read_humanoid(data, _LIMITS).humanoid)


def places_in(tree: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Return the path of every value in a JSON document."""
    found = [path] if path else []
    if isinstance(tree, dict | list):
        for step, child in tree.items() if isinstance(tree, dict) else enumerate(tree):
            found += places_in(child, (*path, step))
    return found


_PLACES = [places_in(taken_apart(seed)[0]) for seed in _SEEDS]


@st.composite
def edited(draw: st.DrawFn) -> bytes:
    """Draw a model in whose JSON a few values are replaced."""
    number = draw(st.integers(0, len(_SEEDS) - 1))
    document, binary = taken_apart(_SEEDS[number])
    for _ in range(draw(st.integers(1, 3))):
        path = draw(st.sampled_from(_PLACES[number]))
        found: Any = document
        try:
            for step in path[:-1]:
                found = found[step]
            found[path[-1]] = draw(st.sampled_from(_ODD))
        except (KeyError, IndexError, TypeError):
            continue  # an earlier edit removed this path
    return glb(json.loads(json.dumps(document)), binary)


@st.composite
def damaged(draw: st.DrawFn) -> bytes:
    """Draw a model with changed bytes or a missing end."""
    data = bytearray(draw(st.sampled_from(_SEEDS)))
    for _ in range(draw(st.integers(1, 20))):
        data[draw(st.integers(0, len(data) - 1))] = draw(st.integers(0, 255))
    return bytes(data[: draw(st.integers(len(data) // 2, len(data)))])


_BOUNDED = settings(
    max_examples=usually(50, at_length=150),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


@_BOUNDED
@given(edited())
def test_an_edited_json_is_read_or_rejected(data: bytes) -> None:
    """A model in whose JSON any values are replaced is read or rejected."""
    survives(data)


@_BOUNDED
@given(damaged())
def test_damaged_bytes_are_read_or_rejected(data: bytes) -> None:
    """A model with changed bytes or a missing end is read or rejected."""
    survives(data)


@pytest.mark.long
@settings(_BOUNDED, max_examples=3_000)
@given(st.one_of(edited(), damaged()))
def test_many_damaged_models_are_read_or_rejected(data: bytes) -> None:
    """Ten times as many damaged models as in the short test are read or rejected."""
    survives(data)


def test_models_damaged_in_every_way_are_read_or_rejected() -> None:
    """Plain and compressed models with lying sizes, changed streams and structures, and cut ones.

    `python -m tests.adapters.humanoids.fuzzing --long` does the same 3,000 times, also to published
    models, in a process with the server's limits.
    """
    outcomes = Counter(
        attempt(damaged_model(number, published=False).data, _LIMITS).outcome
        for number in range(60)
    )
    assert outcomes["read"] >= 3
    assert outcomes["refused"] >= 20
