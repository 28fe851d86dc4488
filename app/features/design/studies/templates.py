"""Studies to begin with: the shipped ones, and templates that are never stored as studies."""

from functools import lru_cache
from pathlib import Path

from app.features.design.studies.draft_schemas import TemplateView
from app.protocol import Plain, read_source
from app.resources import study_configs_dir


def template_files() -> tuple[Path, ...]:
    """The templates first, from small to large, then the shipped studies."""
    root = study_configs_dir()
    templates = sorted((root / "templates").glob("*.yaml"), key=lambda file: file.stat().st_size)
    return (*sorted(root.glob("*.yaml")), *templates)


@lru_cache(maxsize=1)
def templates() -> tuple[TemplateView, ...]:
    """Each file with its name in all its languages."""
    return tuple(_view(file) for file in template_files())


def _view(file: Path) -> TemplateView:
    text = file.read_text(encoding="utf-8")
    tree = read_source(text).tree
    assert isinstance(tree, dict)  # noqa: S101 - a test loads every one of them
    return TemplateView(
        key=file.stem,
        title=_texts(tree.get("title")),
        description=_texts(tree.get("description")),
        yaml=text,
    )


def _texts(value: Plain) -> dict[str, str]:
    return {key: str(words) for key, words in value.items()} if isinstance(value, dict) else {}
