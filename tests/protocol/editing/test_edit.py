"""Tests that edits of a file's text change what they should and no other character."""

import copy

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.protocol import ConfigError
from app.protocol.editing import Change, edit_text
from app.protocol.editing.change import applied, same
from app.protocol.source import Path, Plain, read_source
from tests.protocol.helpers import CONFIGS, STUDY, loaded
from tests.support.repetitions import usually

FILES = tuple(
    file.read_text(encoding="utf-8")
    for file in sorted(CONFIGS.rglob("*.yaml"))
    if file.parent.name != "templates"
)
FMS: dict[str, Plain] = {"step": "form", "instrument": "fms"}
words = st.text(st.characters(exclude_categories=["Cs"]), max_size=60)
scalars = (
    st.none()
    | st.booleans()
    | st.integers(-(2**53) + 1, 2**53 - 1)
    | st.floats(allow_nan=False, allow_infinity=False, width=32)
    | words
    | st.sampled_from(["no", "12:30", "010", "null", "a: b", "# x", "- y", " lead", "x\n\ny\n", ""])
)
values = st.recursive(
    scalars,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True), inner, max_size=3)
    ),
    max_leaves=6,
)


def paths(tree: Plain, path: Path = ()) -> list[Path]:
    """Return the path of every value in a tree except for its root."""
    found: list[Path] = []
    children: list[tuple[str | int, Plain]] = []
    if isinstance(tree, dict):
        children = list(tree.items())
    elif isinstance(tree, list):
        children = list(enumerate(tree))
    for part, inner in children:
        found += [(*path, part), *paths(inner, (*path, part))]
    return found


@st.composite
def changes(draw: st.DrawFn) -> tuple[str, Change]:
    """Draw a shipped file and a change that can be made in it."""
    text = draw(st.sampled_from(FILES))
    tree = read_source(text).tree
    path = draw(st.sampled_from(paths(tree)))
    at = path[-1]
    if not isinstance(at, int):
        if draw(st.booleans()):
            return text, Change(path, "set", draw(values))
        if draw(st.booleans()):
            return text, Change((*path[:-1], "brand_new"), "set", draw(values))
        return text, Change(path, "remove")
    action = draw(st.sampled_from(["set", "remove", "insert", "move"]))
    siblings = sum(1 for one in paths(tree) if one[:-1] == path[:-1])
    to = draw(st.integers(0, siblings - 1))
    return text, Change(path, action, draw(values), to)  # type: ignore[arg-type]  # drawn


@settings(max_examples=usually(25, at_length=100), deadline=None)
@given(changes())
def test_a_change_does_just_what_it_says(case: tuple[str, Change]) -> None:
    """The edited text gives the changed tree, or the change raises an error with a remedy."""
    text, change = case
    before = read_source(text).tree
    expected = applied(copy.deepcopy(before), change)
    try:
        after = edit_text(text, [change])
    except ConfigError as error:
        # Only what no file may contain at all: control characters and too much depth.
        assert all(problem.remedy for problem in error.problems)  # noqa: PT017 - either way is fine
        return
    assert same(read_source(after).tree, expected)


@settings(max_examples=usually(15, at_length=60), deadline=None)
@given(st.data())
def test_a_change_of_one_number_changes_one_line(data: st.DataObject) -> None:
    """Changing a number changes one line; all others stay, comments included."""
    text = data.draw(st.sampled_from(FILES))
    tree = read_source(text).tree
    numbers = [path for path in paths(tree) if isinstance(_at(tree, path), int | float)]
    path = data.draw(st.sampled_from(numbers))
    after = edit_text(text, [Change(path, "set", 123457)])
    old, new = text.split("\n"), after.split("\n")
    assert len(old) == len(new)
    assert sum(one != other for one, other in zip(old, new, strict=True)) == 1


def _at(tree: Plain, path: Path) -> Plain:
    for part in path:
        tree = tree[part]  # type: ignore[index]  # checked by the path
    return tree


def test_comments_survive_every_kind_of_change() -> None:
    """No change to the shipped study, such as an insertion or a move, loses a comment."""
    after = edit_text(
        STUDY,
        [
            Change(("conditions", 1, "latency_ms"), "set", 200),
            Change(("conditions", 1, "key"), "set", "latency_200"),
            Change(
                ("procedure", "block", "after", 0), "insert", {"step": "form", "instrument": "fms"}
            ),
            Change(("procedure", "before", 1), "move", to=2),
            Change(("procedure", "before", 5), "remove"),
            Change(("texts", "consent", "en"), "set", "One\n\nTwo"),
        ],
    )
    hash_lines = [line for line in STUDY.split("\n") if line.lstrip().startswith("#")]
    # Lines that begin with # inside of a text are headings, not comments.
    comments = [line for line in hash_lines if not line.startswith("      #")]
    assert [line for line in comments if line not in after.split("\n")] == []
    protocol = loaded(after).protocol
    assert protocol.conditions[1].latency_ms == 200
    assert protocol.texts["consent"]["en"] == "One\n\nTwo"


def test_a_new_entry_is_written_like_its_neighbours() -> None:
    """A new condition is written with one key per line, as the others are."""
    label = {"en": "half a second", "de": "eine halbe Sekunde"}
    value: Plain = {"key": "latency_500", "latency_ms": 500, "label": {**label}}
    after = edit_text(STUDY, [Change(("conditions", 3), "insert", value)])
    assert (
        "  - key: latency_500\n    latency_ms: 500\n"
        "    label: {en: half a second, de: eine halbe Sekunde}\n"
    ) in after


@pytest.mark.parametrize(
    "change",
    [
        Change((), "set", {}),
        Change(("nothing", "here"), "set", 1),
        Change(("conditions", 9), "remove"),
        Change(("conditions", 0), "move", to=9),
        Change(("orders", "seed"), "move"),
    ],
)
def test_a_change_that_does_not_fit_is_rejected_with_its_path(change: Change) -> None:
    """A change to a path that the file does not have raises an error that names that path."""
    with pytest.raises(ConfigError) as caught:
        edit_text(STUDY, [change])
    (problem,) = caught.value.problems
    assert problem.path
    assert problem.remedy
