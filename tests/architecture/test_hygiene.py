"""Tests that no machine path, registry address or other people's data are committed."""

import hashlib
import json
import re
from collections.abc import Iterator
from pathlib import Path

import pathspec
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
LOCK_FILES = ("requirements.lock", "requirements-dev.lock")
# Spelled in parts, so that this file does not match itself.
PRIVATE_FOLDERS = re.compile("/(?:" + "|".join(["root", "work", r"home/\w+", r"Users/\w+"]) + ")/")


@pytest.fixture(scope="module")
def committed() -> list[Path]:
    """Provide every file that git would track by the rules of `.gitignore`; git is not needed."""
    rules = (REPOSITORY / ".gitignore").read_text().splitlines()
    ignored = pathspec.GitIgnoreSpec.from_lines([*rules, ".git"])
    return sorted(_not_ignored(REPOSITORY, ignored))


def _not_ignored(folder: Path, ignored: pathspec.GitIgnoreSpec) -> Iterator[Path]:
    for path in folder.iterdir():
        name = path.relative_to(REPOSITORY).as_posix()
        if path.is_dir() and not path.is_symlink():
            if not ignored.match_file(f"{name}/"):
                yield from _not_ignored(path, ignored)
        elif not ignored.match_file(name):
            yield path


def test_no_file_names_a_folder_of_somebodys_machine(committed: list[Path]) -> None:
    """No file contains a path below a home or work folder, which exists on one machine only."""
    found = [
        f"{path.relative_to(REPOSITORY)}:{number}: {line.strip()[:100]}"
        for path in committed
        for number, line in enumerate(path.read_text(errors="ignore").splitlines(), 1)
        if PRIVATE_FOLDERS.search(line)
    ]
    assert found == []


@pytest.mark.parametrize("name", LOCK_FILES)
def test_python_lock_files_name_no_host(name: str) -> None:
    """Python lock files name no host: installers choose the index, and hashes verify packages."""
    lines = (REPOSITORY / name).read_text().splitlines()
    assert [line for line in lines if "://" in line or "index-url" in line] == []


def test_node_lock_files_name_no_host(committed: list[Path]) -> None:
    """Node lock files contain an integrity hash for each package and no package addresses."""
    locks = [path for path in committed if path.name == "package-lock.json"]
    assert locks, "no package-lock.json was found: this test looks in the wrong place"
    for lock in locks:
        packages = json.loads(lock.read_text())["packages"]
        assert [name for name, package in packages.items() if "resolved" in package] == []
        assert [
            name for name, package in packages.items() if name and "integrity" not in package
        ] == []


def test_there_is_no_second_lock_file(committed: list[Path]) -> None:
    """No uv.lock exists, since it would name registry hosts and could contradict the other lock."""
    assert [path for path in committed if path.name == "uv.lock"] == []


def test_no_shared_data_was_copied_in(committed: list[Path], shared_data: Path) -> None:
    """No file equals one of the published data, even under another name."""
    theirs = {_digest(path): path for path in shared_data.rglob("*") if _is_content(path)}
    copies = [(path, theirs[_digest(path)]) for path in committed if _digest(path) in theirs]
    assert copies == []


def _is_content(path: Path) -> bool:
    """Return whether a file is too long to equal another by chance."""
    return path.is_file() and path.stat().st_size > 200


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
