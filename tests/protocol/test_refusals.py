"""Tests that broken study and instrument files raise errors with useful problems.

A valid file is broken at a random place. Then it is either still valid or rejected with
ConfigError, each problem with its place and a remedy; nothing else is ever raised.
"""

import json
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.protocol import ConfigError, ConfigProblem, load_instrument
from app.protocol.source import Path, Plain, read_source
from tests.protocol.editing.test_edit import paths
from tests.protocol.helpers import CONFIGS, loaded
from tests.support.repetitions import usually

STUDIES = tuple(file.read_text(encoding="utf-8") for file in sorted(CONFIGS.glob("**/*.yaml"))
                if file.parent.name != "instruments")  # fmt: skip
INSTRUMENTS = tuple(
    file.read_text(encoding="utf-8") for file in sorted((CONFIGS / "instruments").glob("*.yaml"))
)
ODD: tuple[Plain, ...] = (
    None, True, -1, 0, 10**15, 1e300, "", "no such thing", "x" * 5000, [], {}, [[]], [None],
    {"unknown": 1}, ["a", "a"], {"en": ""}, {"en": 5},
)  # fmt: skip
BROKEN = ("*alias", "&anchor x", "!!python/name:os.system", "{", "]", "\t", "<<: {a: 1}", "'", "%")

breakages = st.sampled_from(["delete", "replace", "unknown", "alias", "nest", "cut"])


def broken_tree(tree: Plain, path: Path, kind: str, odd: Plain) -> Plain:
    """Return the tree with one value deleted or replaced, or with an unknown key added."""
    tree = json.loads(json.dumps(tree))
    node: Any = tree
    for part in path[:-1]:
        node = node[part]
    if kind == "delete":
        del node[path[-1]]
    elif kind == "unknown" and isinstance(node, dict):
        node["a_key_nobody_knows"] = odd
    else:
        node[path[-1]] = odd
    return tree


@st.composite
def broken_files(draw: st.DrawFn, files: tuple[str, ...]) -> str:
    """Draw a shipped file with one to three mistakes, or with damaged text."""
    text = draw(st.sampled_from(files))
    kind = draw(breakages)
    if kind in ("alias", "cut"):
        at = draw(st.integers(0, len(text)))
        return text[:at] + (draw(st.sampled_from(BROKEN)) + text[at:] if kind == "alias" else "")
    tree = read_source(text).tree
    if kind == "nest":
        depth = draw(st.integers(1, 400))
        opening, closing = draw(st.sampled_from([("[", "]"), ("{a: ", "}")]))
        return json.dumps(tree)[:-1] + ', "deep": ' + opening * depth + closing * depth + "}"
    for _ in range(draw(st.integers(1, 3))):
        path = draw(st.sampled_from(paths(tree)))
        tree = broken_tree(tree, path, kind, draw(st.sampled_from(ODD)))
    return json.dumps(tree, ensure_ascii=False)


def check(problems: tuple[ConfigProblem, ...]) -> None:
    """Assert that every problem has a place, a message and a remedy."""
    assert problems
    for problem in problems:
        assert problem.message
        assert problem.remedy, problem
        assert problem.path or problem.line >= 1, problem


@settings(
    max_examples=usually(40, at_length=120),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
@given(broken_files(STUDIES))
def test_a_broken_study_is_rejected_with_place_and_remedy(text: str) -> None:
    """A broken study is still valid or raises ConfigError with places and remedies."""
    try:
        loaded(text)
    except ConfigError as error:
        check(error.problems)


@settings(
    max_examples=usually(40, at_length=120),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
@given(broken_files(INSTRUMENTS))
def test_a_broken_instrument_is_rejected_with_place_and_remedy(text: str) -> None:
    """A broken instrument is still valid or raises ConfigError with places and remedies."""
    try:
        load_instrument(text)
    except ConfigError as error:
        check(error.problems)


@settings(max_examples=usually(50, at_length=150), deadline=None)
@given(st.text(max_size=300))
def test_any_text_at_all_is_read_or_rejected(text: str) -> None:
    """Any text is read as a study or raises ConfigError with places and remedies."""
    try:
        loaded(text)
    except ConfigError as error:
        check(error.problems)
