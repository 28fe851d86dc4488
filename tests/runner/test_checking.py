"""Tests that `./run check` checks everything a change may break, and starts no server."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support import checking
from tests.support.checking import Chosen, NoSuchPath, mirror, plan, without_inner
from tests.support.unit_tests import STARTERS

REPOSITORY = Path(__file__).resolve().parents[2]
NEEDING = """
import pytest
from tests.support.unit_tests import needs

@pytest.fixture
def live_server(): raise AssertionError("it was started")

@pytest.fixture
def site(live_server): return live_server

def test_alone(): pass
def test_with_a_server(live_server): pass
def test_with_a_site(site): pass
def test_with_a_server_in_its_body(): needs("a server"); raise AssertionError
@pytest.mark.parametrize("engine", ["sqlite", "postgresql"])
def test_on_both_engines(engine): pass
"""


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Provide a repository with nested features, whose tests mirror them."""
    for file in (
        "app/main.py",
        "app/features/record/sessions/service.py",
        "app/features/record/notes/service.py",
        "tests/builders.py",
        "tests/features/record/test_wing.py",
        "tests/features/record/sessions/builders.py",
        "tests/features/record/sessions/test_service.py",
    ):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).touch()
    return tmp_path


@pytest.mark.parametrize(
    ("path", "tests"),
    [
        ("app/features/record/sessions", "tests/features/record/sessions"),
        ("app/features/record/sessions/service.py", "tests/features/record/sessions"),
        ("app/features/record/notes", "tests/features/record"),
        ("app/features/record", "tests/features/record"),
        ("app/main.py", "tests"),
        ("migrations/env.py", "tests"),
        (".", "tests"),
        ("tests/features/record/test_wing.py", "tests/features/record/test_wing.py"),
        ("tests/features/record/sessions/builders.py", "tests/features/record/sessions"),
        ("tests/builders.py", "tests"),
    ],
)
def test_tests_are_found_by_their_place(tree: Path, path: str, tests: str) -> None:
    """The tests of a path are its mirror below `tests`, or the mirror of its nearest parent."""
    assert mirror(Path(path), tree) == Path(tests)


def test_what_is_inside_another_folder_runs_once() -> None:
    """A path inside another chosen folder is not run twice."""
    paths = map(Path, ("tests/a/b", "tests/a", "tests/c.py", "tests/a/b/d", "tests/c.py"))
    assert without_inner(paths) == [Path("tests/a"), Path("tests/c.py")]


def test_a_missing_path_lists_existing_ones(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """For a missing path, the contents of the nearest existing folder are listed."""
    assert checking.main(["app/no-such-folder/deep"]) == 2
    told = capsys.readouterr().err
    assert "there is no app/no-such-folder/deep; app has " in told
    assert "features" in told


def test_a_path_outside_the_repository_is_rejected() -> None:
    """A path outside the repository is rejected."""
    with pytest.raises(NoSuchPath, match="outside"):
        Chosen.of([".."])


def test_without_paths_everything_is_checked() -> None:
    """Without paths everything is checked, with the unit tests last and alone."""
    planned = plan(Chosen.of([]))
    assert [stage.name for stage in planned if stage.alone] == ["unit tests"]
    assert planned[-1].name == "unit tests"
    assert {"mypy", "imports", "ruff check", "frontend tests"} <= {one.name for one in planned}


def test_only_a_given_path_has_its_thorough_tests_run() -> None:
    """A check of everything leaves out thorough tests and rehearsals; a given path runs its own."""
    everything = plan(Chosen.of([]))[-1].command
    assert "not thorough" in everything
    assert "--ignore=tests/rehearsal" in everything
    given = next(one for one in plan(Chosen.of(["app/rehearsal"])) if one.name == "unit tests")
    assert "not thorough" not in given.command
    assert "tests/rehearsal" in given.command


def test_a_features_check_leaves_out_the_pages() -> None:
    """A feature's check runs its own tests in one process and leaves out the pages."""
    planned = {stage.name: stage for stage in plan(Chosen.of(["app/api"]))}
    assert set(planned) == {"ruff check", "ruff format", "mypy", "imports", "unit tests"}
    assert "tests/api" in planned["unit tests"].command
    assert not planned["unit tests"].alone


def test_the_pages_check_leaves_out_python() -> None:
    """Checking a folder of the pages lints and tests it, checks all types and skips Python."""
    planned = {stage.name: stage for stage in plan(Chosen.of(["frontend/src/shared"]))}
    assert set(planned) == {"frontend lint", "frontend types", "frontend tests"}
    assert str(REPOSITORY / "frontend/src/shared") in planned["frontend tests"].command


def test_tests_that_need_a_server_are_skipped(tmp_path: Path) -> None:
    """Tests that need a server, PostgreSQL or a browser are deselected or skipped."""
    (tmp_path / "test_needing.py").write_text(NEEDING)
    options = ["-c", "/dev/null", "-p", "tests.support.unit_tests", "-rs", str(tmp_path)]
    told = subprocess.run(
        [sys.executable, "-m", "pytest", *options],
        cwd=REPOSITORY,
        env=os.environ,
        capture_output=True,
        text=True,
        check=False,
    ).stdout
    assert "2 passed, 1 skipped, 3 deselected" in told
    assert "left to ./run test: it needs a server" in told


def test_every_starter_is_a_fixture() -> None:
    """Every name in STARTERS, the fixtures that start a server or the like, is a fixture."""
    conftests = (REPOSITORY / folder / "conftest.py" for folder in ("tests", "tests/e2e"))
    defined = "".join(file.read_text() for file in conftests)
    assert [name for name in STARTERS if f"def {name}(" not in defined] == []
