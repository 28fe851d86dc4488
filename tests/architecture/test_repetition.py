"""Tests that the tree has few duplicate lines, and that these are counted correctly."""

from tests.architecture.repetition import found, repeats, significant
from tests.architecture.trees import REPOSITORY

MOST_LINES = 160
"""A third of the 480 that the tree repeated when they were first counted."""
RUN = "".join(f"step_{n}()\n" for n in range(8))


def test_the_tree_repeats_few_lines() -> None:
    """The number of duplicate lines in the tree is below the limit; the message lists them."""
    all_of_them = repeats(REPOSITORY)
    lines = "\n".join(f"{one.lines} lines: {one.first} ~ {one.again}" for one in all_of_them)
    assert sum(one.lines for one in all_of_them) <= MOST_LINES, lines


def test_a_run_that_occurs_twice_is_found_once() -> None:
    """A run that occurs twice is found once, with both places and its whole length."""
    files = {name: significant(name, text) for name, text in (("a.py", RUN), ("b.py", "x\n" + RUN))}
    (one,) = found(files)
    assert (one.first, one.again, one.lines) == ("a.py:1", "b.py:2", 8)


def test_a_file_can_repeat_itself() -> None:
    """A repetition within one file counts, but a run of equal lines does not repeat itself."""
    (one,) = found({"a.py": significant("a.py", RUN + "between()\n" + RUN)})
    assert (one.first, one.again, one.lines) == ("a.py:1", "a.py:10", 8)
    assert found({"a.py": significant("a.py", "same()\n" * 7)}) == []


def test_imports_and_comments_are_not_repetitions() -> None:
    """Imports, comments, blank lines and lone punctuation do not count, in either language."""
    python = "from a import (\n    b,\n    c,\n    d,\n    e,\n    f,\n    g,\n)\n# note\n\n"
    assert significant("a.py", python) == []
    typescript = 'import {\n  a,\n  b,\n} from "./c";\n// note\n/** doc */\n});\n\n'
    assert significant("a.ts", typescript) == []


def test_lines_with_other_names_are_not_repetitions() -> None:
    """Lines of the same shape with other names are not a repetition."""
    other = RUN.replace("step", "stage")
    assert found({"a.py": significant("a.py", RUN), "b.py": significant("b.py", other)}) == []
