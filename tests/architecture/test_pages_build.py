"""Tests that the pages are built only when their sources have changed.

A frontend of one script and no packages replaces the real one; npm and Node are the real ones.
"""

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
BUILD = """
const fs = require("fs");
fs.rmSync("../app/static", { recursive: true, force: true });
fs.mkdirSync("../app/static", { recursive: true });
fs.writeFileSync("../app/static/index.html", fs.readFileSync("src/page.html"));
fs.appendFileSync("../builds", "x");
"""


@pytest.fixture
def builder() -> ModuleType:
    """Provide the module `build_pages`, which does not belong to a package."""
    spec = importlib.util.spec_from_file_location("build_pages", REPOSITORY / "build_pages.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def frontend(tmp_path: Path) -> Path:
    """Provide a frontend whose build copies one page and counts its runs."""
    folder = tmp_path / "frontend"
    (folder / "src").mkdir(parents=True)
    package = {"name": "stand-in", "version": "1.0.0", "scripts": {"build": "node build.js"}}
    lock = {"lockfileVersion": 3, "packages": {"": {"name": "stand-in", "version": "1.0.0"}}}
    (folder / "package.json").write_text(json.dumps(package))
    (folder / "package-lock.json").write_text(json.dumps(lock))
    (folder / "build.js").write_text(BUILD)
    (folder / "src" / "page.html").write_text("first")
    return folder


def build(builder: ModuleType, frontend: Path) -> tuple[str, int]:
    """Build the pages; return the page and the number of builds so far."""
    static = frontend.parent / "app" / "static"
    builder.build_pages(frontend, static)
    page = (static / "index.html").read_text()
    return page, len((frontend.parent / "builds").read_text())


def test_unchanged_sources_are_not_rebuilt(builder: ModuleType, frontend: Path) -> None:
    """Unchanged sources are not rebuilt, but changed ones are."""
    assert build(builder, frontend) == ("first", 1)
    assert build(builder, frontend) == ("first", 1)
    (frontend / "src" / "page.html").write_text("second")
    assert build(builder, frontend) == ("second", 2)


def test_build_products_are_not_sources(builder: ModuleType, frontend: Path) -> None:
    """Installed packages, hidden files and compiler output do not change the sources' hash."""
    before = builder.sources_hash(frontend)
    for name in ("node_modules/a/index.js", "dist/page.js", ".vite/x", "tsconfig.tsbuildinfo"):
        (frontend / name).parent.mkdir(parents=True, exist_ok=True)
        (frontend / name).write_text("a product")
    assert builder.sources_hash(frontend) == before


def test_names_and_contents_both_count(builder: ModuleType, frontend: Path) -> None:
    """Renaming a file, or moving text from one file to the next, changes the sources' hash."""
    hashes = {builder.sources_hash(frontend)}
    (frontend / "src" / "page.html").rename(frontend / "src" / "pagf.html")
    hashes.add(builder.sources_hash(frontend))
    (frontend / "src" / "pagf.html").write_text("fir")
    (frontend / "src" / "pagg.html").write_text("st")
    hashes.add(builder.sources_hash(frontend))
    (frontend / "src" / "pagf.html").write_text("f")
    (frontend / "src" / "pagg.html").write_text("irst")
    hashes.add(builder.sources_hash(frontend))
    assert len(hashes) == 4


def test_the_docs_are_sources(builder: ModuleType, frontend: Path) -> None:
    """A change of the docs, which the console shows as help, changes the hash; decisions do not."""
    hashes = {builder.sources_hash(frontend)}
    (frontend.parent / "docs" / "decisions").mkdir(parents=True)
    (frontend.parent / "docs" / "decisions" / "why.md").write_text("because")
    hashes.add(builder.sources_hash(frontend))
    assert len(hashes) == 1
    for text in ("first", "second"):
        (frontend.parent / "docs" / "tour.md").write_text(text)
        hashes.add(builder.sources_hash(frontend))
    assert len(hashes) == 3


def test_a_failed_build_shows_npms_output_and_is_retried(
    builder: ModuleType, frontend: Path
) -> None:
    """A failed build shows npm's output and is retried by the next call."""
    build(builder, frontend)
    (frontend / "build.js").write_text("throw new Error('the page is unhappy')")
    for _ in range(2):
        with pytest.raises(builder.PagesError, match="the page is unhappy"):
            build(builder, frontend)


def test_the_build_installs_only_its_own_packages(
    builder: ModuleType, frontend: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The build installs only its own packages, and an installation of all packages suffices."""
    asked: list[tuple[str, ...]] = []
    monkeypatch.setattr(builder, "npm", lambda _, *arguments: asked.append(arguments))
    for every_package in (False, False, True, True, False):
        builder.install_packages(frontend, every_package=every_package)
    assert ["--omit=dev" in arguments for arguments in asked] == [True, False]


def test_a_tree_without_a_frontend_has_nothing_to_build(
    builder: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A missing frontend is reported but is no error, since the server runs without pages."""
    builder.build_pages(tmp_path / "frontend", tmp_path / "static")
    assert "no pages to build" in capsys.readouterr().err
