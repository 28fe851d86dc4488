"""`./run check [PATHS]`: check for everything that a change may have broken, in 1 to 4 minutes.

With paths, it checks the format and lint of these, the types and import contracts of everything,
and runs the tests that mirror them; `tests/` has the folders of `app/`, and a folder without a
mirror has its parent's tests. Without paths, it checks everything. In both cases no server, no
PostgreSQL and no browser is started: tests that need one run only in `./run test`
(`tests.support.unit_tests`). So do the tests of faults, whole rehearsals and the tests marked as
thorough, unless their path is given.
"""

import argparse
import sys
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.support.node import NODE
from tests.support.stage_runner import CORES, REPOSITORY, Stage, exit_with, print_stages, run_stages
from tests.support.stages import (
    ARCHITECTURE_TESTS,
    BROWSER_TESTS,
    FRONTEND,
    LINT_IMPORTS,
    OURS,
    frontend_stage,
    frontend_stages,
    node_stage,
    pytest_stage,
    python_stage,
)

USAGE_ERROR = 2
TESTS = Path("tests")
BIOME = FRONTEND / "node_modules" / "@biomejs" / "biome" / "bin" / "biome"
SOURCES = FRONTEND / "src"
LONG_FOLDERS = (TESTS / "faults", TESTS / "rehearsal")
"""Killed processes, failing disks and whole sessions take minutes: `./run test` tests them."""


class NoSuchPath(ValueError):
    """Raised for a path outside the repository; the message says which paths exist."""


@dataclass(frozen=True)
class Chosen:
    """The paths to check: relative to the repository, or for pages to the frontend."""

    python: tuple[Path, ...]
    pages: tuple[Path, ...]

    @classmethod
    def of(cls, paths: Iterable[str]) -> "Chosen":
        """Sort the paths into Python and pages; raises `NoSuchPath`."""
        known = [_known(path) for path in paths]
        pages = tuple(path for path in known if path.parts[:1] == ("frontend",))
        return cls(tuple(path for path in known if path not in pages), pages)


def _known(path: str) -> Path:
    full = (REPOSITORY / path).resolve()
    if not full.is_relative_to(REPOSITORY):
        raise NoSuchPath(f"{path} is outside of {REPOSITORY}")
    if not full.exists():
        there = next(parent for parent in full.parents if parent.is_dir())
        names = sorted(one.name for one in there.iterdir() if one.name[0] not in "._")
        folder = there.relative_to(REPOSITORY)
        raise NoSuchPath(f"there is no {path}; {folder} has {', '.join(names)}")
    return full.relative_to(REPOSITORY)


def mirror(path: Path, root: Path = REPOSITORY) -> Path:
    """Return the tests of `path`: its counterpart below `tests`, else the nearest parent's."""
    first, *rest = path.parts or (".",)
    if first not in ("app", "tests"):
        return TESTS
    mirrored = TESTS.joinpath(*rest)
    while not _has_tests(root / mirrored):
        mirrored = mirrored.parent
    return mirrored


def _has_tests(path: Path) -> bool:
    if path.is_dir():
        return next(path.rglob("test_*.py"), None) is not None
    return path.is_file() and path.name.startswith("test_")


def without_inner(paths: Iterable[Path]) -> list[Path]:
    """Return each of `paths` that is not inside another of them."""
    unique = sorted(set(paths))
    return [one for one in unique if not any(other in one.parents for other in unique)]


def plan(chosen: Chosen) -> list[Stage]:
    """Return the stages for the chosen paths, or for everything if none were chosen."""
    everything = not (chosen.python or chosen.pages)
    planned: list[Stage] = []
    if chosen.python or everything:
        planned += _source_stages(chosen.python)
    if chosen.pages or everything:
        planned += _page_stages(chosen.pages)
    if chosen.python or everything:
        # Last, because it uses both cores.
        planned.append(_units(without_inner(map(mirror, chosen.python or [Path()]))))
    return planned


def _source_stages(paths: Sequence[Path]) -> list[Stage]:
    ours = [path for path in paths if path.suffix in ("", ".py")] if paths else OURS
    found = [*map(str, ours), "--force-exclude"]
    ruff = [
        python_stage("ruff check", "-m", "ruff", "check", *found),
        python_stage("ruff format", "-m", "ruff", "format", "--check", *found),
    ]
    return [
        *(ruff if ours else []),
        # Everything, since a change can break code elsewhere; unchanged files come from the cache.
        python_stage("mypy", "-m", "mypy"),
        python_stage("imports", "-c", LINT_IMPORTS),
    ]


def _page_stages(paths: Sequence[Path]) -> list[Stage]:
    if not paths or not all((REPOSITORY / path).is_relative_to(SOURCES) for path in paths):
        return frontend_stages()
    given = [str(path.relative_to("frontend")) for path in paths]
    folders = [path if path.is_dir() else path.parent for path in map(REPOSITORY.joinpath, paths)]
    return [
        node_stage("frontend lint", str(NODE), str(BIOME), "check", *given),
        frontend_stage("frontend types", "typecheck"),
        frontend_stage("frontend tests", "test", "--passWithNoTests", *map(str, folders)),
    ]


def _units(tests: Sequence[Path]) -> Stage:
    """Return the stage of unit tests; a few tests run in one process to save start-up time."""
    options = ["-p", "tests.support.unit_tests", "-rfE"]
    if TESTS not in tests:
        return pytest_stage("unit tests", *options, *map(str, tests))
    spread = ["-n", str(CORES), "--dist", "worksteal"]
    folders = (ARCHITECTURE_TESTS, BROWSER_TESTS, *LONG_FOLDERS)
    left_out = [*(f"--ignore={folder}" for folder in folders), "-m", "not thorough"]
    return pytest_stage(
        "unit tests", *options, *spread, *left_out, str(TESTS), alone=True, aloud=True
    )


def main(arguments: list[str]) -> int:
    """Run the stages for the paths; return 2 if a path is not in the repository."""
    parser = argparse.ArgumentParser(
        prog="./run check", description=(__doc__ or "").partition(": ")[2]
    )
    parser.add_argument(
        "paths", nargs="*", metavar="PATH", help="a file or folder of the repository"
    )
    try:
        planned = plan(Chosen.of(parser.parse_args(arguments).paths))
    except NoSuchPath as error:
        sys.stderr.write(f"./run check: {error}\n")
        return USAGE_ERROR
    began_s = time.monotonic()
    outcomes = run_stages(planned, brief=True)
    print_stages(outcomes, time.monotonic() - began_s)
    return 0 if all(outcome.passed for outcome in outcomes) else 1


if __name__ == "__main__":
    exit_with(main)
