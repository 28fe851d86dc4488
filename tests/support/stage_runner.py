"""Run the stages of a project check on two cores and report their results.

A stage that fails does not prevent the others from running: one call shows everything that is
wrong. Two stages run at a time and print their output when they end, so no core stays idle for
long. A stage that must run alone prints its output while it runs.
"""

# ruff: noqa: T201  # what it prints is what it is for

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from itertools import groupby
from pathlib import Path
from threading import Lock
from typing import IO, Any, NoReturn

from tests.support.tally import TALLY_VARIABLE, Tally
from tests.support.warden import Ended, run_warded

REPOSITORY = Path(__file__).resolve().parents[2]
# As many as a small machine has.
CORES = 2
FAILED_TO_START = Ended(1, 0.0, 0.0, 0.0)
ONE_AT_A_TIME = Lock()


@dataclass(frozen=True)
class Stage:
    """A command, its folder, and the preparation it needs.

    `alone`: nothing else may run at the same time. `aloud`: its output is printed while it runs.
    """

    name: str
    command: list[str]
    folder: Path = REPOSITORY
    environment: dict[str, str] = field(default_factory=dict)
    prepare: Callable[[], None] | None = None
    alone: bool = False
    aloud: bool = False


@dataclass(frozen=True)
class Outcome:
    """The result of running one stage."""

    stage: Stage
    ended: Ended
    tally: Tally

    @property
    def passed(self) -> bool:
        """Return whether the stage found no problem."""
        return self.ended.code == 0


def inherited() -> dict[str, str]:
    """Return the environment variables of a stage, which let stages share compiled modules."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def run_stages(planned: Sequence[Stage], *, brief: bool = False) -> list[Outcome]:
    """Run every stage in order, two at a time where allowed.

    If `brief`, stages that find no problem get one line.
    """
    outcomes: list[Outcome] = []
    for alone, neighbours in groupby(planned, lambda stage: stage.alone):
        group = list(neighbours)
        outcomes += (
            [_run_beside(stage, brief=brief) for stage in group]
            if alone
            else _side_by_side(group, brief=brief)
        )
    return outcomes


def _side_by_side(planned: list[Stage], *, brief: bool) -> list[Outcome]:
    with ThreadPoolExecutor(CORES) as threads:
        try:
            return list(threads.map(partial(_run_beside, brief=brief), planned))
        except BaseException:
            threads.shutdown(cancel_futures=True)
            raise


def _run_beside(stage: Stage, *, brief: bool) -> Outcome:
    return _run_aloud(stage) if stage.aloud else _run_silently(stage, brief=brief)


def _run_aloud(stage: Stage) -> Outcome:
    """Run a stage and print its output while it runs."""
    print(_heading(stage.name), flush=True)
    outcome = _run(stage)
    print(_ending(outcome), flush=True)
    return outcome


def _run_silently(stage: Stage, *, brief: bool) -> Outcome:
    """Run a stage and print its output at the end, in one piece."""
    with tempfile.TemporaryFile() as output:
        outcome = _run(stage, output)
        output.seek(0)
        said = output.read().decode(errors="replace").rstrip()
    shown = [] if brief and outcome.passed else [_heading(stage.name), said]
    lines = [*filter(None, shown), _ending(outcome)]
    with ONE_AT_A_TIME:
        print("\n".join(lines), flush=True)
    return outcome


def _run(stage: Stage, output: IO[bytes] | None = None) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        tally_file = Path(folder) / "tally.json"
        try:
            if stage.prepare:
                stage.prepare()
            ended = run_warded(
                stage.command,
                folder=stage.folder,
                environment={**inherited(), **stage.environment, TALLY_VARIABLE: str(tally_file)},
                output=output,
                errors=subprocess.STDOUT if output else None,
            )
        except (OSError, RuntimeError) as error:
            print(f"{stage.name}: {error}", file=sys.stderr)
            ended = FAILED_TO_START
        return Outcome(stage, ended, Tally.read(tally_file))


def _heading(title: str) -> str:
    return f"\n=== {title} {'=' * (74 - len(title))}"


def _ending(outcome: Outcome) -> str:
    result = "ok" if outcome.passed else f"FAILED ({outcome.ended.code})"
    return f"--- {outcome.stage.name}: {result} after {outcome.ended.wall_s:.1f} s"


def summed(outcomes: Sequence[Outcome]) -> Tally:
    """Return the sum of the counts of all pytest runs."""
    total = Tally()
    for outcome in outcomes:
        total.add(outcome.tally)
    return total


def print_tests(outcomes: Sequence[Outcome]) -> None:
    """Print which tests were skipped, and which took longest."""
    total = summed(outcomes)
    if total.skips:
        print("\nSkipped:")
        for test, reason in total.skips:
            print(f"  {test}: {reason}")
    if total.slowest:
        print("\nSlowest:")
        for test, taken_s in total.slowest:
            print(f"{taken_s:8.1f} s  {test}")


def print_stages(outcomes: Sequence[Outcome], wall_s: float) -> None:
    """Print the closing table; the very last line is the sum of all pytest runs."""
    print(_heading("summary"))
    print(f"{'':<29} {'wall':>10} {'processor':>12}")
    for outcome in outcomes:
        result = "ok" if outcome.passed else "FAILED"
        print(f"{outcome.stage.name:<20} {result:<8} {_times(outcome.ended)}")
    processor_s = sum(outcome.ended.processor_s for outcome in outcomes)
    print(f"{'all':<29} {wall_s:8.1f} s {processor_s:10.1f} s")
    total = summed(outcomes)
    print(f"\n{total.passed} passed, {total.failed} failed, {total.skipped} skipped", flush=True)


def _times(ended: Ended) -> str:
    return f"{ended.wall_s:8.1f} s {ended.processor_s:10.1f} s"


def as_json(outcomes: Sequence[Outcome], wall_s: float) -> dict[str, Any]:
    """Return the results as JSON; `./run test --help` describes the fields."""
    total = summed(outcomes)
    return {
        "ok": all(outcome.passed for outcome in outcomes),
        "wall_s": wall_s,
        "processor_s": sum(outcome.ended.processor_s for outcome in outcomes),
        **_counts(total),
        "stages": [
            {
                "name": outcome.stage.name,
                "ok": outcome.passed,
                "wall_s": outcome.ended.wall_s,
                "processor_s": outcome.ended.processor_s,
                **_counts(outcome.tally),
            }
            for outcome in outcomes
        ],
        "slowest": [{"name": test, "seconds": taken_s} for test, taken_s in total.slowest],
        "skips": [{"name": test, "reason": reason} for test, reason in total.skips],
    }


def _counts(tally: Tally) -> dict[str, int]:
    return {"passed": tally.passed, "failed": tally.failed, "skipped": tally.skipped}


def exit_with(main: Callable[[list[str]], int]) -> NoReturn:
    """Exit with the code that `main` returns, or as shells do after an interrupt."""
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
