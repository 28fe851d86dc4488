"""Tests that packages contain everything that runs: pages, migrations and study configs."""

import shutil
import subprocess
import tarfile
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Provide a folder with the sdist, and the wheel built from the sdist."""
    folder = tmp_path_factory.mktemp("built")
    uv = shutil.which("uv") or str(REPOSITORY / ".uv" / "bin" / "uv")
    result = subprocess.run(
        [uv, "build", "--quiet", "--out-dir", str(folder), str(REPOSITORY)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    return folder


@pytest.fixture(scope="module")
def wheel(built: Path) -> set[str]:
    """Provide the names of the wheel's files."""
    (path,) = built.glob("*.whl")
    with zipfile.ZipFile(path) as archive:
        return set(archive.namelist())


@pytest.fixture(scope="module")
def sdist(built: Path) -> set[str]:
    """Provide the names of the sdist's files, without its top folder."""
    (path,) = built.glob("*.tar.gz")
    with tarfile.open(path) as archive:
        return {member.name.partition("/")[2] for member in archive if member.isfile()}


def files(folder: str, pattern: str) -> set[str]:
    """Return the repository's files below `folder`, by their paths relative to it."""
    top = REPOSITORY / folder
    return {path.relative_to(top).as_posix() for path in top.rglob(pattern) if path.is_file()}


def test_the_wheel_contains_the_built_pages(wheel: set[str]) -> None:
    """Every file of the built pages is in the wheel."""
    pages = {f"app/static/{name}" for name in files("app/static", "*")}
    assert any(name.endswith(".html") for name in pages)
    assert pages - wheel == set()


@pytest.mark.parametrize(
    ("folder", "pattern"), [("migrations", "*.py"), ("study_configs", "*.y*ml")]
)
def test_the_wheel_contains_migrations_and_study_configs(
    wheel: set[str], folder: str, pattern: str
) -> None:
    """The wheel contains migrations and study configs where `app.resources` looks for them."""
    wanted = {f"app/_bundled/{folder}/{name}" for name in files(folder, pattern)}
    assert wanted
    assert wanted - wheel == set()


def test_the_sdist_contains_the_pages_and_their_sources(sdist: set[str]) -> None:
    """The sdist contains the built pages and everything needed to rebuild them."""
    assert {
        "frontend/package.json",
        "frontend/package-lock.json",
        "hatch_build.py",
        "build_pages.py",
        # The console's help pages are built from them.
        "docs/README.md",
        "docs/images/tour.png",
        "study_configs/README.md",
    } <= sdist
    assert "app/static/.build-hash" in sdist


def test_no_package_contains_local_files(wheel: set[str], sdist: set[str]) -> None:
    """No package contains environments, caches, installed packages or studies' data."""
    made = (".venv/", ".uv/", ".cache/", "data/", ".ci/")
    assert [name for name in wheel | sdist if name.startswith(made)] == []
    assert [name for name in wheel | sdist if "node_modules" in name] == []
