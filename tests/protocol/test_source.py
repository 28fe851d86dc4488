"""Tests of reading YAML strictly: plain types, positions of values, rejected constructs."""

import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.protocol import ConfigError
from app.protocol.source import MAX_DEPTH, MAX_FILE_BYTES, MAX_NODES, Mark, read_source


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("no", "no"),
        ("On", "On"),
        ("yes", "yes"),
        ("true", True),
        ("False", False),
        ("12:30", "12:30"),
        ("2020-04-15", "2020-04-15"),
        ("010", "010"),
        ("0x1F", "0x1F"),
        ("1_000", "1_000"),
        ("-7", -7),
        ("1.10", 1.1),
        ("1e3", 1000.0),
        (".5", 0.5),
        ('"5"', "5"),
        ("!!str 5", "5"),
        ("~", None),
        ("", None),
        ("=", "="),
    ],
)
def test_only_true_false_and_decimal_numbers_are_special(word: str, value: object) -> None:
    """Plain words other than true, false and decimal numbers, such as `no`, stay text."""
    tree = read_source(f"a: {word}\n").tree
    assert tree == {"a": value}
    assert isinstance(tree, dict)
    assert type(tree["a"]) is type(value)


def test_keys_are_always_text() -> None:
    """YAML keys such as `no`, `5` and `true` are read as text."""
    assert read_source("{no: 1, 5: 2, true: 3}").tree == {"no": 1, "5": 2, "true": 3}


def test_values_and_keys_have_their_position() -> None:
    """Values and keys have a line and a column from 1; missing ones have their parent's."""
    source = read_source("a:\n  - x: 1\n    y: 2\n")
    assert source.place(("a", 0, "y")) == Mark(3, 8)
    assert source.place(("a", 0, "y"), of_key=True) == Mark(3, 5)
    assert source.place(("a", 0, "z", "w")) == Mark(2, 5)


def bomb(levels: int) -> str:
    """Return the billion-laughs file: each level repeats the one before nine times."""
    lines = ["a0: &a0 [x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, levels)]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "line", "column", "expected_message"),
    [
        (bomb(12), 1, 5, "Anchors (&a0)"),
        ("a: 1\nb: *a\n", 2, 4, "Aliases (*a)"),
        ("a: {x: 1}\nb:\n  <<: {y: 2}\n", 3, 3, "Merge keys"),
        ("a: 1\nb: !!python/object/apply:os.system [ls]\n", 2, 4, "tag"),
        ("a: !custom 1\n", 1, 4, "tag"),
        ("a: !!binary aGk=\n", 1, 4, "tag"),
        ("[" * 100_000, 1, MAX_DEPTH + 1, "nested"),
        ("{a: " * 50_000, 1, 4 * MAX_DEPTH + 1, "nested"),
        ("- " * 50_000, 1, 2 * MAX_DEPTH + 1, "nested"),
        ("[" + "1," * MAX_NODES + "]", 1, 2 * MAX_NODES, "more than"),
        ("a: " + "x" * MAX_FILE_BYTES, 1, 1, "bytes"),
        ("a: 1\n---\nb: 2\n", 2, 1, "second document"),
        ("a: 1\n  b: 2\n", 2, 4, "not valid YAML"),
        ('a: "open\n', 2, 1, "not valid YAML"),
        ("a: \x07\n", 1, 4, "U+0007"),
        ("", 1, 1, "empty"),
        ("# nothing\n", 2, 1, "empty"),
        ("? [a, b]\n: 1\n", 1, 3, "key is not text"),
    ],
)
def test_dangerous_yaml_is_rejected_at_its_place(
    text: str, line: int, column: int, expected_message: str
) -> None:
    """YAML bombs, tags, too much depth or size and syntax errors are rejected unexpanded."""
    with pytest.raises(ConfigError) as caught:
        read_source(text)
    (problem,) = caught.value.problems
    assert (problem.line, problem.column) == (line, column)
    assert expected_message in problem.message
    assert problem.remedy


@pytest.mark.parametrize(
    ("text", "place", "expected_message"),
    [
        ("a: 1\nb: 2\na: 3\n", (3, 1), "occurs twice; first in line 1"),
        ("a: .nan\n", (1, 4), "not a finite number"),
        ("a: -.inf\n", (1, 4), "not a finite number"),
        ("a: Infinity\n", (1, 4), "not a finite number"),
        ("a: 1e999\n", (1, 4), "too large"),
        ("a: 9007199254740992\n", (1, 4), "too large"),
        (f"a: {'9' * 5000}\n", (1, 4), "too large"),
        ('a: "x\\0"\n', (1, 4), "U+0000"),
        ('a: "\\ud800"\n', (1, 4), "U+D800"),
    ],
)
def test_small_problems_are_collected(
    text: str, place: tuple[int, int], expected_message: str
) -> None:
    """Problems that leave the rest readable are collected with those that follow."""
    source = read_source(text)
    (problem,) = source.problems
    assert (problem.line, problem.column) == place
    assert expected_message in problem.message


def test_of_duplicate_keys_the_first_counts() -> None:
    """A duplicate key does not change the first value."""
    source = read_source("a: {x: 1}\na: {y: 2}\n")
    assert source.tree == {"a": {"x": 1}}
    assert source.place(("a",)) == Mark(1, 4)


def test_quoted_words_are_text() -> None:
    """Quoted words such as "nan" are text."""
    assert read_source("a: 'nan'\n").tree == {"a": "nan"}


@given(st.text("ab:-[]{},&*!<#|>'\"\n 1.~%@?", max_size=60))
def test_any_text_is_a_tree_or_a_config_error(text: str) -> None:
    """Any text is read or raises ConfigError, never another exception."""
    with contextlib.suppress(ConfigError):
        assert read_source(text).place(()).line >= 1
