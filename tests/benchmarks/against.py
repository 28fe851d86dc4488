"""`./run bench NAME --against COMMIT`: compare this tree's processor time with COMMIT's.

Both trees run their own benchmark file with the same arguments, alternately and in changing order,
so that other load on the machine affects both equally. COMMIT is checked out into a temporary
folder and uses this tree's environment, or one of its own if its locked dependencies differ. A
run's time is user and system time of all its processes, servers and loads included; each tree runs
once before measurements start, so that nothing is compiled in a measured run. Both sides of a ratio
include the start of Python: a difference looks a little smaller than it is.

Some benchmarks take minutes; without `--only` these run in the short form of `SHORT`. Pages are not
compared: COMMIT's server serves those of this tree.
"""

import argparse
import ast
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.benchmarks.report import CannotMeasure, Figure, Report
from tests.support.shared_data import SHARED_DATA_VARIABLE
from tests.support.warden import run_warded

REPOSITORY = Path(__file__).resolve().parents[2]
LOCK = "requirements-dev.lock"
PAIRS = 6
"""The fewest pairs whose extremes enclose the median with a confidence of 95 %."""
CONFIDENCE = 0.95
SHORT = {
    "avatar": ("--only", "speed", "--only", "control"),
    "desk": ("--only", "pages"),
    "retargeting": ("--only", "frame", "--only", "batch"),
    "telemetry": ("--only", "load", "--seconds", "20"),
    "walking": ("--only", "sampling"),
}
NOT_WORK = {"__main__.py", "against.py", "report.py"}


@dataclass(frozen=True)
class Side:
    """One of the two source trees that are compared."""

    name: str
    folder: Path
    python: Path
    scratch: Path

    def run(self, arguments: Sequence[str]) -> "Run":
        """Run the tree's benchmark once; raise `CannotMeasure` with its error output on failure."""
        self.scratch.mkdir(exist_ok=True)
        with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
            ended = run_warded(
                [str(self.python), "-m", "tests.benchmarks", *arguments, "--json"],
                folder=self.folder,
                environment=self._environment(),
                output=output,
                errors=errors,
            )
            told, complaints = _content(output), _content(errors)
        if ended.code != 0:
            raise CannotMeasure(f"{self.name} ended with {ended.exit_code}:\n{complaints[-3000:]}")
        return Run(ended.processor_s, json.loads(told)["figures"])

    def _environment(self) -> dict[str, str]:
        kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        shared_data = REPOSITORY.parent / "shared" / "data"
        return {
            SHARED_DATA_VARIABLE: str(shared_data),
            **kept,
            "PYTHONPATH": str(self.folder),
            "TMPDIR": str(self.scratch),
        }


@dataclass(frozen=True)
class Run:
    """The processor time and the figures of one run of a benchmark."""

    processor_s: float
    figures: list[dict[str, Any]]


@dataclass(frozen=True)
class Interval:
    """The median of pairwise ratios, and the two ratios that enclose the true median."""

    median: float
    low: float
    high: float
    confidence: float


def compare(asked: argparse.Namespace) -> Report:
    """Run both trees in pairs; return this tree's medians, with those of COMMIT as their peer."""
    if asked.pairs < 1:
        raise CannotMeasure(f"{asked.pairs} pairs; at least 1 is needed")
    if asked.write:
        raise CannotMeasure("--write stores what this tree measures; leave --against away")
    arguments = [asked.name, *_chosen(asked)]
    with (
        tempfile.TemporaryDirectory(prefix="reembody-against-") as scratch,
        _sides(asked.against, Path(scratch)) as (ours, theirs),
    ):
        differing = differing_files(ours.folder, theirs.folder)
        if differing:
            _say(f"both sides run their own files; these differ: {', '.join(differing)}")
        for side in (ours, theirs):
            _say(f"{side.name} runs once before it counts: {' '.join(arguments)}")
            side.run(arguments)
        pairs = list(_pairs(ours, theirs, arguments, asked.pairs))
    return _report(asked, theirs.name, pairs, differing)


def _chosen(asked: argparse.Namespace) -> list[str]:
    """Return the benchmark's arguments, which are the same for both trees."""
    seconds = asked.seconds or (60.0 * asked.minutes if asked.minutes else None)
    chosen = [word for part in asked.only or () for word in ("--only", part)]
    chosen += [] if seconds is None else ["--seconds", f"{seconds:g}"]
    return chosen or list(SHORT.get(asked.name, ()))


def _pairs(
    ours: Side, theirs: Side, arguments: Sequence[str], count: int
) -> Iterator[tuple[Run, Run]]:
    for number in range(count):
        if number % 2:
            that, this = theirs.run(arguments), ours.run(arguments)
        else:
            this, that = ours.run(arguments), theirs.run(arguments)
        ratio = this.processor_s / that.processor_s
        _say(
            f"pair {number + 1} of {count}: {this.processor_s:.2f} s, "
            f"{theirs.name} {that.processor_s:.2f} s, ratio {ratio:.3f}"
        )
        yield this, that


def interval(ratios: Sequence[float]) -> Interval:
    """Return the median with an interval of order statistics (that of the sign test).

    Of n independent ratios the k-th lowest and k-th highest enclose the true median with the
    probability 1 - 2 P(B(n, 1/2) < k), whatever their distribution. k is the largest for which that
    is at least 95 %; with fewer than six ratios it is 1, and the confidence is lower.
    """
    ordered, count = sorted(ratios), len(ratios)
    missed, depth = 2 * 0.5**count, 0
    while True:
        more = missed + 2 * math.comb(count, depth + 1) * 0.5**count
        if 1.0 - more < CONFIDENCE:
            break
        missed, depth = more, depth + 1
    low, high = ordered[depth], ordered[count - 1 - depth]
    return Interval(statistics.median(ordered), low, high, max(0.0, 1.0 - missed))


def _report(
    asked: argparse.Namespace,
    commit: str,
    pairs: Sequence[tuple[Run, Run]],
    differing: Sequence[str],
) -> Report:
    report = Report(asked.name)
    found = interval([this.processor_s / that.processor_s for this, that in pairs])
    report.beside = {
        "against": commit,
        "pairs": len(pairs),
        "ratio_median": found.median,
        "ratio_low": found.low,
        "ratio_high": found.high,
        "ratio_confidence": found.confidence,
        "workload_differs": list(differing),
    }
    ours, theirs = ([pair[at] for pair in pairs] for at in (0, 1))
    medians = [statistics.median(run.processor_s for run in runs) for runs in (ours, theirs)]
    report.figures.append(
        Figure("against", "processor time, median", medians[0], "s", commit, medians[1])
    )
    peers = _medians(theirs)
    units = {(one["part"], one["name"]): one["unit"] for one in ours[0].figures}
    for (part, name), value in _medians(ours).items():
        unit, peer = units.get((part, name), ""), peers.get((part, name))
        report.figures.append(Figure(part, name, value, unit, commit, peer))
    _say(
        f"ratio {found.median:.3f}, from {found.low:.3f} to {found.high:.3f} "
        f"({100 * found.confidence:.1f} % by order statistics)"
    )
    return report


def _medians(runs: Sequence[Run]) -> dict[tuple[str, str], float]:
    values: dict[tuple[str, str], list[float]] = {}
    for run in runs:
        for one in run.figures:
            values.setdefault((one["part"], one["name"]), []).append(one["value"])
    return {key: statistics.median(several) for key, several in values.items()}


@contextmanager
def _sides(commit: str, scratch: Path) -> Iterator[tuple[Side, Side]]:
    """Yield this tree and COMMIT's tree, which is removed with `scratch`."""
    folder = scratch / "tree"
    name = check_out(REPOSITORY, commit, folder)
    python = Path(sys.executable)
    if (folder / LOCK).read_bytes() != (REPOSITORY / LOCK).read_bytes():
        _say(f"{name} has other dependencies, and gets them")
        python = _set_up(folder)
    elif not (folder / "app" / "static").exists() and (REPOSITORY / "app" / "static").exists():
        (folder / "app" / "static").symlink_to(REPOSITORY / "app" / "static")
    yield (
        Side("this tree", REPOSITORY, Path(sys.executable), scratch / "a"),
        Side(name, folder, python, scratch / "b"),
    )


def check_out(repository: Path, commit: str, folder: Path) -> str:
    """Write the files of `commit` into `folder` and return its short hash."""
    name = _git(repository, "rev-parse", "--verify", "--quiet", "--short", f"{commit}^{{commit}}")
    if not name:
        raise CannotMeasure(f"git knows no commit {commit}")
    archive = folder.with_suffix(".tar")
    _git(repository, "archive", "--format=tar", f"--output={archive}", name)
    with tarfile.open(archive) as packed:
        # Python 3.11.2, which Debian 12 has, knows no filter; git writes no path outside.
        packed.extraction_filter = getattr(tarfile, "data_filter", None)
        packed.extractall(folder)  # noqa: S202
    archive.unlink()
    return name


def _git(repository: Path, *arguments: str) -> str:
    if shutil.which("git") is None:
        raise CannotMeasure("git is needed to fetch another commit")
    command = ["git", "-C", str(repository), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def _set_up(folder: Path) -> Path:
    """Let a tree set itself up as it would for its tests, and return its interpreter."""
    if (REPOSITORY / ".uv").is_dir():
        (folder / ".uv").symlink_to(REPOSITORY / ".uv")
    with tempfile.TemporaryFile() as output:
        ended = run_warded(["./run", "test", "--help"], folder=folder, output=output)
    if ended.code != 0:
        raise CannotMeasure("the other tree cannot be set up")
    return folder / ".venv" / "bin" / "python"


def differing_files(ours: Path, theirs: Path) -> list[str]:
    """Return the benchmark files whose code differs, apart from imports; modules may have moved."""
    trees = [_workload(folder / "tests" / "benchmarks") for folder in (ours, theirs)]
    return sorted(n for n in {**trees[0], **trees[1]} if trees[0].get(n) != trees[1].get(n))


def _workload(folder: Path) -> dict[str, str]:
    """Return each file's code without its imports, docstrings and comments."""
    files = [file for file in folder.rglob("*.py") if file.name not in NOT_WORK]
    return {str(file.relative_to(folder)): _work_of(file) for file in files}


def _work_of(file: Path) -> str:
    tree = ast.parse(file.read_text(encoding="utf-8"))
    kept = [node for node in tree.body if not isinstance(node, (ast.Import, ast.ImportFrom))]
    if ast.get_docstring(tree) is not None:
        kept = kept[1:]
    return ast.dump(ast.Module(kept, []))


def _content(file: Any) -> str:
    file.seek(0)
    return str(file.read().decode(errors="replace"))


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
