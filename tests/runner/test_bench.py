"""Tests of `./run bench`: benchmarks by name, and this tree compared with another commit."""

import argparse
import os
import signal
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import pytest

from tests.benchmarks import against, vr
from tests.benchmarks.__main__ import NAMES, main, parser
from tests.benchmarks.against import SHORT, check_out, compare, differing_files, interval
from tests.benchmarks.report import CannotMeasure, Figure, Report
from tests.protocol.helpers import SHIPPED, loaded

REPOSITORY = Path(__file__).resolve().parents[2]
BENCHMARKS = REPOSITORY / "tests" / "benchmarks"
BENCHMARK = """
import json, os, sys, time
if {waits}:
    open({mark!r}, "w").write(str(os.getpid()))
    time.sleep(600)
figure = {{"part": "p", "name": "n", "value": {value}, "unit": "s"}}
print(json.dumps({{"figures": [figure], "arguments": sys.argv[1:]}}))
"""
DRIVER = """
import signal
import sys
from itertools import pairwise
from pathlib import Path
from tests.benchmarks import __main__, against
against.REPOSITORY = Path({repository!r})
# A run in the background hands on that Ctrl+C is ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.exit(__main__.main(["desk", "--against", "HEAD"]))
"""
WAITS_S = 60.0


def git(folder: Path, *arguments: str) -> str:
    """Return git's output for a repository, unaffected by the machine's settings."""
    who = ["-c", "user.name=Lab", "-c", "user.email=lab@example.org", "-c", "commit.gpgsign=false"]
    return subprocess.run(
        ["git", *who, *arguments], cwd=folder, check=True, capture_output=True, text=True
    ).stdout


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """Provide a repository whose benchmark gave 2.0 when it was committed, and gives 1.0 now."""
    folder = tmp_path / "repository"
    for name in ("app", "migrations", "tests", "tests/benchmarks"):
        (folder / name).mkdir(parents=True)
        (folder / name / "__init__.py").touch()
    (folder / against.LOCK).write_text("locked\n")
    write_benchmark(folder, 2.0)
    git(folder, "init", "--quiet")
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--message", "first")
    write_benchmark(folder, 1.0)
    return folder


def write_benchmark(folder: Path, value: float, *, waits: bool = False) -> None:
    """Write a benchmark that gives one figure, or one that runs until it is ended."""
    text = BENCHMARK.format(value=value, waits=waits, mark=str(folder.parent / "mark"))
    (folder / "tests" / "benchmarks" / "__main__.py").write_text(text)


@pytest.fixture
def scratch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Provide the folder in which temporary folders are created."""
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    return folder


def asked(*arguments: str) -> argparse.Namespace:
    """Parse benchmark arguments as the command does."""
    return parser().parse_args(arguments)


def test_only_benchmarks_are_offered() -> None:
    """Only modules that measure are offered as benchmarks, not the command or helpers."""
    assert {"avatar", "desk", "retargeting", "telemetry", "vr", "walking"} <= set(NAMES)
    assert not {"__main__", "against", "report", "codecs", "walking_maps"} & set(NAMES)


def test_the_visit_of_the_headsets_page_lasts_as_long_as_asked() -> None:
    """The benchmark's study is the shipped one with physics; only its timed phases are shorter."""
    shipped, asked_for = loaded(SHIPPED).protocol, loaded(vr.study_of(7.0)).protocol
    assert asked_for.key == vr.STUDY
    assert {phase.duration_s for phase in asked_for.procedure.block.phases} == {7.0}
    assert asked_for.avatar == shipped.avatar == "physics"
    assert asked_for.tasks == shipped.tasks


def test_short_forms_name_existing_parts() -> None:
    """Each short form names existing parts of an existing benchmark."""
    assert set(SHORT) <= set(NAMES)
    for name, words in SHORT.items():
        text = (BENCHMARKS / f"{name}.py").read_text()
        parts = [part for option, part in pairwise(words) if option == "--only"]
        assert parts
        assert all(f'"{part}"' in text for part in parts)


@pytest.mark.parametrize(
    ("count", "low", "confidence"),
    [(1, 0, 0.0), (5, 0, 0.9375), (6, 0, 0.96875), (9, 1, 0.9609375), (20, 5, 0.9586105346)],
)
def test_the_interval_is_of_order_statistics(count: int, low: int, confidence: float) -> None:
    """The interval's ends are the order statistics listed in tables of the sign test."""
    found = interval([float(number) for number in range(count)][::-1])
    assert (found.low, found.high) == (low, count - 1 - low)
    assert found.median == (count - 1) / 2
    assert found.confidence == pytest.approx(confidence)


def test_a_limit_is_an_upper_or_a_lower_one() -> None:
    """A peer named "at most" or "at least" is a limit that a value may meet; others are rivals."""
    peers = ("at most", "at least", "bare mj_step")
    rows = [Figure("p", "n", 2.0, "s", peer, 3.0).as_json() for peer in peers]
    assert [(row["limit"], row["met"]) for row in rows] == [(3.0, True), (3.0, False), (None, None)]


def test_a_benchmarks_own_keys_are_added_to_the_report() -> None:
    """Keys specific to a benchmark are added to its report at the top level."""
    told = Report("desk", beside={"pairs": 6}).as_json()
    assert set(told) == {"benchmark", "machine", "figures", "pairs"}


def test_checking_out_a_commit_changes_nothing_in_the_repository(
    repository: Path, tmp_path: Path
) -> None:
    """Checking out a commit writes its files and leaves the repository unchanged."""
    before = git(repository, "status", "--short")
    name = check_out(repository, "HEAD", tmp_path / "tree")
    assert git(repository, "rev-parse", "HEAD").startswith(name)
    assert '"value": 2.0' in (tmp_path / "tree/tests/benchmarks/__main__.py").read_text()
    assert git(repository, "status", "--short") == before
    assert len(git(repository, "worktree", "list").splitlines()) == 1
    assert not (tmp_path / "tree.tar").exists()


def test_an_unknown_commit_is_named(repository: Path, tmp_path: Path) -> None:
    """An unknown commit is named in the error before anything is measured."""
    with pytest.raises(CannotMeasure, match="no commit nowhere"):
        check_out(repository, "nowhere", tmp_path / "tree")


def test_both_sides_run_their_own_tree(
    repository: Path, scratch: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The working tree and the commit each run their own benchmark, and the copy is removed."""
    monkeypatch.setattr(against, "REPOSITORY", repository)
    told = compare(asked("desk", "--against", "HEAD", "--pairs", "2")).as_json()
    assert told["pairs"] == 2
    assert told["ratio_low"] <= told["ratio_median"] <= told["ratio_high"]
    assert [one["name"] for one in told["figures"]] == ["processor time, median", "n"]
    assert [(one["value"], one["peer_value"]) for one in told["figures"]][1] == (1.0, 2.0)
    assert told["figures"][1]["peer"] == told["against"]
    assert list(scratch.iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_comparison_leaves_nothing(repository: Path, number: int) -> None:
    """An interrupted comparison leaves neither the commit's files nor a process."""
    write_benchmark(repository, 1.0, waits=True)
    scratch, mark = repository.parent / "scratch", repository.parent / "mark"
    scratch.mkdir()
    driver = subprocess.Popen(
        [sys.executable, "-c", DRIVER.format(repository=str(repository))],
        cwd=REPOSITORY,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY), "TMPDIR": str(scratch)},
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline_s = time.monotonic() + WAITS_S
    while not (mark.exists() and mark.read_text()):
        assert time.monotonic() < deadline_s, "the benchmark did not begin"
        time.sleep(0.02)
    assert list(scratch.iterdir())
    if number == signal.SIGINT:
        os.killpg(driver.pid, number)
    else:
        driver.send_signal(number)
    assert driver.wait() in (128 + number, -number)
    assert list(scratch.iterdir()) == []
    with pytest.raises(ProcessLookupError):
        os.kill(int(mark.read_text()), 0)


def test_a_different_workload_is_reported(tmp_path: Path) -> None:
    """A changed number is reported as a different workload, but a moved import is not."""
    texts = {
        "moved.py": ("'''Old.'''\nfrom app.a import b\nN = 1\n", "from app.c.a import b\nN = 1\n"),
        "changed.py": ("N = 1\n", "N = 2\n"),
        "report.py": ("N = 1\n", "N = 2\n"),
    }
    for at, side in enumerate(("theirs", "ours")):
        (tmp_path / side / "tests" / "benchmarks").mkdir(parents=True)
        for name, text in texts.items():
            (tmp_path / side / "tests" / "benchmarks" / name).write_text(text[at])
    assert differing_files(tmp_path / "ours", tmp_path / "theirs") == ["changed.py"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("desk", "--against", "HEAD", "--pairs", "0"), "at least 1"),
        (("desk", "--against", "HEAD", "--write"), "leave --against away"),
        (("desk", "--against", "no-such-commit"), "no commit no-such-commit"),
    ],
)
def test_an_impossible_comparison_is_rejected(
    arguments: tuple[str, ...], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """A comparison that is impossible exits with code 2 and says what is possible."""
    before = signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGHUP)
    try:
        assert main(arguments) == 2
    finally:
        signal.signal(signal.SIGTERM, before[0])
        signal.signal(signal.SIGHUP, before[1])
    assert told in capsys.readouterr().err
