"""Tests that the four walks complete on the current tree and are counted as defined."""

import sys
import types
from pathlib import Path

import app
from tests.architecture.drive import Recorder
from tests.architecture.trees import REPOSITORY
from tests.architecture.walks import Walk, walk_of, walks

OURS = Path(app.__file__).parent


def test_repeated_steps_of_a_walk_count_once() -> None:
    """Repeated steps of a walk count once, and files are in the order of their first entry."""
    assert walk_of(["a", "b", "c", "b", "c", "b", "a"]) == Walk(["a", "b", "c"], 4, 2)
    assert walk_of([]) == Walk([], 0, 0)


def test_functions_are_recorded_when_called() -> None:
    """A call of an `app` function is recorded once, even if its generator is resumed."""
    recorder = Recorder()
    spaces = [_module("one", OURS / "one.py"), _module("two", OURS / "two.py")]
    spaces.append(_module("three", OURS.parent / "three.py"))
    one, two, three = (space["numbers"] for space in spaces)
    before = sys.getprofile()
    sys.setprofile(recorder.profile)
    try:
        with recorder.recording():
            for _ in zip(one(), two(), three(), strict=True):
                pass
        list(one())
    finally:
        sys.setprofile(before)
    assert recorder.taken() == ["app/one.py", "app/two.py"]


def _module(name: str, file: Path) -> dict[str, types.FunctionType]:
    space: dict[str, types.FunctionType] = {}
    source = "def numbers():\n    yield 1\n    yield 2\n"
    exec(compile(source, str(file), "exec"), space)  # noqa: S102  # a function of a made-up file
    return space


def test_the_four_walks_complete() -> None:
    """All four walks complete: frame to CSV, answer to score, command to event, capture to BVH."""
    walked = walks(REPOSITORY, rounds=1)
    assert set(walked) == {"frame to CSV", "answer to score", "command to event", "capture to BVH"}
    for name, walk in walked.items():
        assert [file for file in walk.files if not (REPOSITORY / file).is_file()] == []
        assert 0 < walk.returns < walk.steps
        first = walk.files[0]
        assert first.startswith("app/wire/" if name == "frame to CSV" else "app/api/")
