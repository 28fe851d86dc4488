"""`./run test`: run every check of the project, cheap ones first, and print tables at the end.

Given arguments of pytest, only pytest runs, with those arguments.
"""

import argparse
import compileall
import json
import subprocess
import sys
import time
from pathlib import Path

from tests.support.node import NODE, NPM, install_packages, node_environment
from tests.support.stage_runner import (
    CORES,
    ONE_AT_A_TIME,
    REPOSITORY,
    Stage,
    as_json,
    exit_with,
    print_stages,
    print_tests,
    run_stages,
)

FRONTEND = REPOSITORY / "frontend"
# Not ".": outside of a git checkout ruff does not know what is ignored, such as uv in `.uv`.
OURS = ("app", "migrations", "tests", "build_pages.py", "hatch_build.py", "set_up.py")
# All tests in there are browser tests, and no others are.
BROWSER_TESTS = "tests/e2e"
ARCHITECTURE_TESTS = "tests/architecture"
# It packs the whole repository with the pages that the set-up has built.
PACKAGE_TESTS = f"{ARCHITECTURE_TESTS}/test_packages.py"
LINT_IMPORTS = "from importlinter.cli import lint_imports_command; lint_imports_command()"
DESCRIPTION = """\
Without arguments everything is checked: types, lint, format, import contracts, pages, tests on
SQLite and PostgreSQL, a real browser. Arguments that are not listed here go to pytest, which then
runs alone, as in ./run test tests/protocol -q -k loading
"""
EPILOGUE = """\
FILE gets {"ok", "wall_s", "processor_s", "passed", "failed", "skipped", "stages": [...],
"slowest": [...], "skips": [...]}. A stage is {"name", "ok", "wall_s", "processor_s", "passed",
"failed", "skipped"}; processor_s is user and system time of all its processes, also of those
that went into the background. "slowest" are twenty tests, {"name", "seconds"}, their fixtures
included; "skips" are {"name", "reason"}.
"""


def python_stage(name: str, *arguments: str, alone: bool = False, aloud: bool = False) -> Stage:
    """Return a stage that is a Python module or program."""
    return Stage(name, [sys.executable, *arguments], alone=alone, aloud=aloud)


def pytest_stage(name: str, *arguments: str, alone: bool = False, aloud: bool = False) -> Stage:
    """Return a stage that is a pytest run whose counts are added to the total."""
    plugin = ["-m", "pytest", "-p", "tests.support.tally", "-q"]
    return python_stage(name, *plugin, *arguments, alone=alone, aloud=aloud)


def node_stage(name: str, *command: str) -> Stage:
    """Return a stage that runs Node in the frontend."""
    environment = node_environment()
    return Stage(name, [*command], FRONTEND, environment, prepare=_install_packages_once)


def frontend_stage(name: str, script: str, *arguments: str) -> Stage:
    """Return a stage that is a script of the frontend's package.json."""
    passed_on = ["--", *arguments] if arguments else []
    return node_stage(name, str(NODE), str(NPM), "run", "--silent", script, *passed_on)


def _install_packages_once() -> None:
    with ONE_AT_A_TIME:
        install_packages(FRONTEND)


def static_stages() -> list[Stage]:
    """Return the checks of the sources.

    Mypy takes as long as the others together, so it is first.
    """
    return [
        python_stage("mypy", "-m", "mypy"),
        python_stage("ruff check", "-m", "ruff", "check", *OURS),
        python_stage("ruff format", "-m", "ruff", "format", "--check", *OURS),
        python_stage("imports", "-c", LINT_IMPORTS),
    ]


def frontend_stages() -> list[Stage]:
    """Return the checks of the pages: lint, types and tests without a browser."""
    return [
        frontend_stage("frontend lint", "lint"),
        frontend_stage("frontend types", "typecheck"),
        frontend_stage("frontend tests", "test"),
    ]


def stages(*, long: bool) -> list[Stage]:
    """Return all stages, cheap checks first."""
    also_long = ["--long"] if long else []
    spread = ["-n", str(CORES), "--dist", "worksteal"]
    ignored = [f"--ignore={path}" for path in (BROWSER_TESTS, PACKAGE_TESTS)]
    mypy, *quicker = static_stages()
    return [
        mypy,
        # Beside it, and over before any test of a server starts: nothing has to wait for it.
        pytest_stage("packages", PACKAGE_TESTS, *also_long),
        *quicker,
        *frontend_stages(),
        # In parallel: tests wait for servers, pages and clocks, and waiting needs no core.
        pytest_stage("tests", *spread, "-m", "not browser", *ignored, *also_long, aloud=True),
        pytest_stage("browser tests", BROWSER_TESTS, *also_long),
    ]


def compile_ours() -> None:
    """Compile all our modules once: a server without write permission cannot cache them."""
    for folder in ("app", "migrations", "tests"):
        compileall.compile_dir(REPOSITORY / folder, quiet=1)


def main(arguments: list[str]) -> int:
    """Run the stages, or pytest alone; return the exit code."""
    parser = argparse.ArgumentParser(
        prog="./run test",
        usage="%(prog)s [--long] [--json FILE] [PYTEST ARGUMENTS]",
        description=DESCRIPTION,
        epilog=EPILOGUE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--long", action="store_true", help="also the long form of some tests")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write times and counts to FILE")
    asked, of_pytest = parser.parse_known_args(arguments)
    if of_pytest:
        also_long = ["--long"] if asked.long else []
        if asked.json is None:
            command = [sys.executable, "-m", "pytest", *of_pytest, *also_long]
            return subprocess.run(command, check=False).returncode
        planned = [pytest_stage("tests", *of_pytest, *also_long, aloud=True)]
    else:
        compile_ours()
        planned = stages(long=asked.long)
    began_s = time.monotonic()
    outcomes = run_stages(planned)
    wall_s = time.monotonic() - began_s
    print_tests(outcomes)
    print_stages(outcomes, wall_s)
    if asked.json is not None:
        asked.json.write_text(json.dumps(as_json(outcomes, wall_s), indent=2) + "\n")
    return 0 if all(outcome.passed for outcome in outcomes) else 1


if __name__ == "__main__":
    exit_with(main)
