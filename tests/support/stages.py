"""`./run test`: every check of the project, one after the other, and a table at the end.

A stage that fails does not keep the others from running: one call shows everything that is wrong.
With arguments (other than `--long`) only pytest runs, with those arguments.
"""

# ruff: noqa: T201  # what it prints is what it is for

import compileall
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path

from tests.support.node import NODE, NPM, install_packages, node_environment
from tests.support.tally import TALLY_VARIABLE, Tally

REPOSITORY = Path(__file__).resolve().parents[2]
FRONTEND = REPOSITORY / "frontend"
# Not ".": outside of a git checkout ruff does not know what is ignored, such as uv in `.uv`.
OURS = ("app", "migrations", "tests", "build_pages.py", "hatch_build.py", "set_up.py")
# As many as a small machine has cores: with three, tests that keep real time took twice as long.
WORKERS = "2"
# Everything in there is a browser test, and nothing else is one.
BROWSER_TESTS = "tests/e2e"
LINT_IMPORTS = "from importlinter.cli import lint_imports_command; lint_imports_command()"


@dataclass(frozen=True)
class Stage:
    """A command, where it runs, and what must be there before it does."""

    name: str
    command: list[str]
    folder: Path = REPOSITORY
    environment: dict[str, str] = field(default_factory=dict)
    prepare: Callable[[], None] | None = None
    beside: bool = False
    """Runs while the others do, and tells at the end: it keeps one core busy for long."""


@dataclass(frozen=True)
class Outcome:
    """How a stage went."""

    stage: Stage
    passed: bool
    duration_s: float
    tally: Tally


def python_stage(name: str, *arguments: str) -> Stage:
    """A stage that is a Python module or program."""
    return Stage(name, [sys.executable, *arguments])


def pytest_stage(name: str, *arguments: str) -> Stage:
    """A stage that is a pytest run whose counts go into the total."""
    return python_stage(name, "-m", "pytest", "-p", "tests.support.tally", "-q", *arguments)


def npm_stage(name: str, script: str) -> Stage:
    """A stage that is a script of the frontend's package.json."""
    return Stage(
        name,
        [str(NODE), str(NPM), "run", "--silent", script],
        folder=FRONTEND,
        environment=node_environment(),
        prepare=lambda: install_packages(FRONTEND),
    )


def stages(*, long: bool) -> list[Stage]:
    """Everything, cheap checks first."""
    also_long = ["--long"] if long else []
    return [
        python_stage("ruff check", "-m", "ruff", "check", *OURS),
        python_stage("ruff format", "-m", "ruff", "format", "--check", *OURS),
        replace(python_stage("mypy", "-m", "mypy"), beside=True),
        python_stage("imports", "-c", LINT_IMPORTS),
        npm_stage("frontend types", "typecheck"),
        npm_stage("frontend lint", "lint"),
        npm_stage("frontend tests", "test"),
        pytest_stage(
            "tests",
            "-n",
            WORKERS,
            "--dist",
            "worksteal",
            "-m",
            "not browser",
            "--ignore",
            "tests/architecture",
            "--ignore",
            BROWSER_TESTS,
            *also_long,
        ),
        pytest_stage(
            "browser tests", "-n", WORKERS, "--dist", "loadfile", BROWSER_TESTS, *also_long
        ),
        pytest_stage("architecture", "tests/architecture", *also_long),
    ]


def inherited() -> dict[str, str]:
    """The environment of a stage: what one has compiled the next need not compile again."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def run_stage(stage: Stage) -> Outcome:
    """Run one stage with a heading; what it prints goes where ours goes."""
    print(f"\n=== {stage.name} " + "=" * (74 - len(stage.name)), flush=True)
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        tally_file = Path(folder) / "tally.json"
        try:
            if stage.prepare:
                stage.prepare()
            code = subprocess.run(
                stage.command,
                cwd=stage.folder,
                env={**inherited(), **stage.environment, TALLY_VARIABLE: str(tally_file)},
                stdin=subprocess.DEVNULL,
                check=False,
            ).returncode
        except (OSError, RuntimeError) as error:
            print(error, file=sys.stderr)
            code = 1
        tally = Tally.read(tally_file)
    duration_s = time.monotonic() - started
    print(f"--- {'ok' if code == 0 else f'FAILED ({code})'} after {duration_s:.1f} s", flush=True)
    return Outcome(stage, code == 0, duration_s, tally)


def run_beside(stage: Stage) -> tuple[Outcome, str]:
    """Run a stage without a word; returns what it printed, too."""
    started = time.monotonic()
    told = subprocess.run(
        stage.command,
        cwd=stage.folder,
        env={**inherited(), **stage.environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return Outcome(stage, told.returncode == 0, time.monotonic() - started, Tally()), told.stdout


def run_stages(planned: list[Stage]) -> list[Outcome]:
    """Run every stage, those beside the others in a thread of their own."""
    with ThreadPoolExecutor(1) as thread:
        beside = [thread.submit(run_beside, stage) for stage in planned if stage.beside]
        outcomes = [run_stage(stage) for stage in planned if not stage.beside]
        for outcome, printed in (one.result() for one in beside):
            print(f"\n=== {outcome.stage.name} " + "=" * (74 - len(outcome.stage.name)))
            print(printed, end="", flush=True)
            outcomes.append(outcome)
    return outcomes


def print_summary(outcomes: list[Outcome]) -> None:
    """The closing tables; the very last line is the sum of all pytest runs."""
    total = Tally()
    print("\n=== summary " + "=" * 67)
    for outcome in outcomes:
        total.add(outcome.tally)
        result = "ok" if outcome.passed else "FAILED"
        print(f"{outcome.stage.name:<20} {result:<8} {outcome.duration_s:8.1f} s")
    if total.skips:
        print("\nSkipped:")
        for test, reason in total.skips:
            print(f"  {test}: {reason}")
    print(f"\n{total.passed} passed, {total.failed} failed, {total.skipped} skipped", flush=True)


def compile_ours() -> None:
    """Hundreds of servers start; where none may write, each would compile all of it."""
    for folder in ("app", "migrations", "tests"):
        compileall.compile_dir(REPOSITORY / folder, quiet=1)


def main(arguments: list[str]) -> int:
    """Run the stages, or pytest alone; returns the exit code."""
    long = "--long" in arguments
    if [argument for argument in arguments if argument != "--long"]:
        return subprocess.run([sys.executable, "-m", "pytest", *arguments], check=False).returncode
    compile_ours()
    outcomes = run_stages(stages(long=long))
    print_summary(outcomes)
    return 0 if all(outcome.passed for outcome in outcomes) else 1


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
