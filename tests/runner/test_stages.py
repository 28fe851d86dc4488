"""Tests that stages share two cores and that their results are reported in one format."""

import json
import sys
from pathlib import Path

import pytest

from tests.support import stages
from tests.support.stage_runner import REPOSITORY, Outcome, Stage, as_json, run_stages
from tests.support.tally import SLOWEST, Tally
from tests.support.warden import Ended

TEST_FILE = """
import time
import pytest

@pytest.fixture
def slow():
    time.sleep(0.2)

def test_quick(): pass
def test_with_a_slow_fixture(slow): pass
def test_that_is_missing_something(): pytest.skip("it is not there")
"""


def python(name: str, code: str, *, alone: bool = False, aloud: bool = False) -> Stage:
    """Return a stage that runs a piece of Python code."""
    return Stage(name, [sys.executable, "-S", "-c", code], alone=alone, aloud=aloud)


def test_stages_run_after_a_failure(capfd: pytest.CaptureFixture[str]) -> None:
    """After a failed stage the others still run in order, and its output is shown."""
    outcomes = run_stages(
        [python("one", "raise SystemExit('it is wrong')"), python("two", "", alone=True)]
    )
    assert [(one.stage.name, one.passed) for one in outcomes] == [("one", False), ("two", True)]
    assert "it is wrong" in capfd.readouterr().out


def test_two_stages_run_in_parallel(tmp_path: Path) -> None:
    """Two stages that need one core each run in parallel."""
    meet = """
import pathlib, time
pathlib.Path({mine!r}).touch()
while not pathlib.Path({other!r}).exists(): time.sleep(0.01)
"""
    files = [str(tmp_path / name) for name in ("a", "b")]
    pair = [python(own, meet.format(mine=own, other=other)) for own, other in (files, files[::-1])]
    assert all(outcome.passed for outcome in run_stages(pair))


def test_a_stage_that_is_alone_waits_and_prints_as_it_goes(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """A stage that must run alone waits for earlier ones and prints under its own heading."""
    done = tmp_path / "done"
    late = f"import pathlib, time; time.sleep(0.2); pathlib.Path({str(done)!r}).touch()"
    look = f"import pathlib; print('it was', pathlib.Path({str(done)!r}).exists())"
    run_stages([python("one", late), python("two", look, alone=True, aloud=True)])
    assert "it was True" in capfd.readouterr().out.partition("=== two")[2]


def test_in_brief_mode_a_passed_stage_gets_one_line(capfd: pytest.CaptureFixture[str]) -> None:
    """In brief mode a stage that passes gets one line."""
    run_stages([python("chatty", "print('all is well')")], brief=True)
    told = capfd.readouterr().out
    assert "all is well" not in told
    assert told.startswith("--- chatty: ok")


def test_a_stage_with_a_failed_preparation_fails() -> None:
    """A stage fails if its preparation fails."""

    def prepare() -> None:
        raise RuntimeError("no packages")

    (outcome,) = run_stages([Stage("pages", ["true"], prepare=prepare)])
    assert not outcome.passed


def test_times_and_counts_are_sums_of_stages() -> None:
    """Times and counts in the file of --json are sums over the stages."""
    first = Tally(3, 1, 1, [("a", "not there")], [("a", 2.0), ("b", 1.0)])
    second = Tally(2, 0, 0, [], [("c", 1.5)])
    outcomes = [
        Outcome(Stage("one", []), Ended(1, 4.0, 2.0, 1.0), first),
        Outcome(Stage("two", []), Ended(0, 5.0, 0.5, 0.5), second),
    ]
    told = json.loads(json.dumps(as_json(outcomes, 9.0)))
    assert (told["ok"], told["wall_s"], told["processor_s"]) == (False, 9.0, 4.0)
    assert (told["passed"], told["failed"], told["skipped"]) == (5, 1, 1)
    assert [(one["name"], one["ok"], one["processor_s"]) for one in told["stages"]] == [
        ("one", False, 3.0),
        ("two", True, 1.0),
    ]
    assert [one["name"] for one in told["slowest"]] == ["a", "c", "b"]
    assert told["skips"] == [{"name": "a", "reason": "not there"}]


def test_only_the_slowest_are_kept() -> None:
    """Only the twenty slowest tests are kept over several runs."""
    total = Tally()
    for run in range(3):
        total.add(Tally(slowest=[(f"{run} {at}", float(at)) for at in range(SLOWEST)]))
    assert len(total.slowest) == SLOWEST
    assert total.slowest[0][1] == SLOWEST - 1


def test_a_pytest_run_can_be_reported_as_json(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """`./run test PATH --json FILE` writes counts and each test's time with its fixtures."""
    (tmp_path / "test_some.py").write_text(TEST_FILE)
    file = tmp_path / "told.json"
    arguments = [str(tmp_path), "-c", "/dev/null", "--json", str(file)]
    assert stages.main(arguments) == 0
    assert capfd.readouterr().out.endswith("2 passed, 0 failed, 1 skipped\n")
    told = json.loads(file.read_text())
    assert (told["passed"], told["skipped"]) == (2, 1)
    assert told["slowest"][0]["name"].endswith("test_with_a_slow_fixture")
    assert told["slowest"][0]["seconds"] >= 0.2


def test_help_describes_the_json(capsys: pytest.CaptureFixture[str]) -> None:
    """The help describes every key of the JSON file."""
    with pytest.raises(SystemExit):
        stages.main(["--help"])
    told = capsys.readouterr().out
    assert all(f'"{key}"' in told for key in as_json([], 0.0))


def test_builds_and_browser_tests_have_stages_of_their_own() -> None:
    """Everything that the stage of all tests ignores is run by a separate stage."""
    commands = {stage.name: stage.command for stage in stages.stages(long=False)}
    ignored = [word.partition("=")[2] for word in commands["tests"] if word.startswith("--ignore=")]
    others = {path for path in ignored for name in commands if path in commands[name]}
    assert sorted(others) == sorted(ignored)
    assert all((REPOSITORY / path).exists() for path in ignored)
