"""Run `reembody avatar`: edit, compare and convert configurations."""

import json
from collections.abc import Iterable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.cli.avatar.library import Library
from app.cli.avatar.saving import Saved, ToSave, based_on, change_json
from app.cli.avatar.sources import Source, read, read_file, text_of, versions_of
from app.cli.avatars import check_key, check_words
from app.cli.outputs import require_folder_of, require_output
from app.protocol import ConfigError, did_you_mean
from app.protocol.avatar import avatar_text, content_of, loaded, single_text
from app.protocol.avatar_editing import (
    AvatarOperation,
    Edited,
    differences,
    edited,
    operation_models,
    read_operations,
    sums_by_group,
)
from app.protocol.avatar_joints import joint_files
from app.science.avatar.configuration import (
    AvatarProblem,
    AvatarSettingsError,
    Configuration,
    axes_of,
    parts_of,
)
from app.whole_files import prepared, write_whole

_TEMPLATES = ("single", "multiple")
_MOST_WORDS = 12
"""How many valid words an error names; most lists of groups and axes are much longer."""


@dataclass(frozen=True)
class EditOrder:
    """The options of `avatar edit`."""

    source: str
    operations: tuple[str, ...]
    operations_file: Path | None
    out: Path | None
    save: str | None
    title: str | None
    note: str
    based_on: int | None


@dataclass(frozen=True)
class Done:
    """An edited or converted configuration: what changed, and where it was written and stored."""

    edited: Edited
    content_hash: str
    out: Path | None
    saved: Saved | None

    @property
    def as_json(self) -> dict[str, Any]:
        """Return the result for scripts."""
        return {
            "content_hash": self.content_hash,
            "changed": [change_json(one) for one in self.edited.changed],
            "lost": [
                {
                    "operation": one.operation,
                    "change": change_json(one.change),
                    "reason": one.reason,
                }
                for one in self.edited.lost
            ],
            "written": None if self.out is None else str(self.out),
            "saved": None if self.saved is None else self.saved.as_json,
            "configuration": content_of(self.edited.configuration),
        }


@dataclass(frozen=True)
class Shown:
    """A configuration, or a body group of it, in one of the two templates."""

    source: Source
    group: str
    single: bool

    @property
    def configuration(self) -> Configuration:
        """The whole configuration."""
        return self.source.configuration

    @property
    def as_json(self) -> dict[str, Any]:
        """Return the file's content, only with the axes or joints of the group."""
        content = content_of(self.configuration)
        axes = content.pop("axes")
        key, version = self.source.saved or (None, None)
        hashed = {
            "content_hash": loaded(self.configuration).content_hash,
            "saved": None if key is None else {"key": key, "version": version},
            **content,
            "format": self.source.form,
            "version": self.source.form_version,
        }
        if self.single:
            present = joint_files(self.configuration)
            rows = {part: present[part] for part in parts_of(self.group) if part in present}
            return {**hashed, "joints": {part: one.model_dump() for part, one in rows.items()}}
        chosen = set(axes_of(self.group))
        return {**hashed, "axes": {name: one for name, one in axes.items() if name in chosen}}


def shown(library: Library, source: str, group: str, *, single: bool) -> Shown:
    """Read what `avatar show` prints; raises ValueError, OSError, NotFound."""
    try:
        parts_of(group)
    except AvatarSettingsError as error:
        raise ValueError(
            "\n".join(f"--group: {problem_text(one)}" for one in error.problems)
        ) from None
    return Shown(read(library, source), group, single)


def edit(library: Library, order: EditOrder) -> Done:
    """Apply operations, then write and store the result as requested.

    Raises ValueError with every problem, OSError, ReembodyError. Then nothing is written or stored:
    a version cannot be taken back, so it is stored only once its file is ready.
    """
    # The source may be replaced by what is made of it; its operations may not.
    require_output(order.out, order.operations_file)
    if order.save is not None:
        check_key("--save", order.save)
        check_words(order.title, order.note)
    operations = [*_from_file(order.operations_file), *_parsed(order.operations)]
    if not operations:
        raise ValueError("there is nothing to do: give --operation or --operations")
    source = read(library, order.source)
    done = edited(source.configuration, operations, versions_of(library))
    if done.problems:
        raise ValueError(_problems_text(done))
    ready: AbstractContextManager[None] = nullcontext()
    if order.out is not None:
        ready = prepared(order.out, avatar_text(done.configuration))
    saved = None
    with ready:
        if order.save is not None:
            begun_from = based_on(order.based_on, source, order.save)
            new = ToSave(
                done.configuration, order.save, order.title, order.note, begun_from, loaded=False
            )
            saved = new.stored(library)
    return Done(done, loaded(done.configuration).content_hash, order.out, saved)


def save(
    library: Library,
    file: Path,
    key: str,
    title: str | None,
    note: str,
    number: int | None,
) -> Saved:
    """Store a file under a new key, or as the next version of an avatar, made from `number`.

    Raises ValueError with every problem of the file, OSError, ReembodyError.
    """
    check_key("KEY", key)
    check_words(title, note)
    configuration = read_file(file).configuration
    return ToSave(configuration, key, title, note, number, loaded=True).stored(library)


def convert(library: Library, source: str, to: str, out: Path) -> Done:
    """Write a configuration in a template; raises ValueError, OSError, ReembodyError."""
    if to not in _TEMPLATES:
        meant = did_you_mean(to, _TEMPLATES)
        valid = ", ".join(_TEMPLATES)
        raise ValueError(f"--to {to!r} is no template: valid are {valid}. {meant}".rstrip())
    require_folder_of(out)
    operations = read_operations(json.dumps({"operation": "convert", "to": to}))
    done = edited(read(library, source).configuration, operations, versions_of(library))
    text = (single_text if to == "single" else avatar_text)(done.configuration)
    write_whole(out, text)
    return Done(done, loaded(done.configuration).content_hash, out, None)


def load(library: Library, source: str, out: Path) -> dict[str, Any]:
    """Write a configuration as a file; raises ValueError, OSError, NotFound."""
    require_folder_of(out)
    found = read(library, source)
    write_whole(out, avatar_text(found.configuration))
    key, version = found.saved or (None, None)
    return {
        "content_hash": loaded(found.configuration).content_hash,
        "written": str(out),
        "saved": None if key is None else {"key": key, "version": version},
    }


def compared(library: Library, old: str, new: str) -> dict[str, Any]:
    """Return how two configurations differ; raises ValueError, OSError, NotFound."""
    before, after = (read(library, one).configuration for one in (old, new))
    changes = differences(before, after)
    return {
        "old": {"source": old, "content_hash": loaded(before).content_hash},
        "new": {"source": new, "content_hash": loaded(after).content_hash},
        "same": not changes,
        "changed": [change_json(one) for one in changes],
        "groups": [
            {"group": group, "parts": list(parts), "values": values}
            for group, (parts, values) in sums_by_group(changes).items()
        ],
    }


def operation_schemas() -> dict[str, Any]:
    """Return the JSON schema of every operation, by its name."""
    return {name: model.model_json_schema() for name, model in operation_models().items()}


def problem_text(problem: AvatarProblem) -> str:
    """Format a problem of a configuration, with the word that was probably meant."""
    words = (
        [one for one in problem.valid if isinstance(one, str)]
        if isinstance(problem.valid, list)
        else []
    )
    meant = did_you_mean(problem.value, words)
    valid = problem.valid if isinstance(problem.valid, str) else ", ".join(words[:_MOST_WORDS])
    more = ", ..." if len(words) > _MOST_WORDS else ""
    return f"{problem} {meant}".rstrip() + (f" Valid: {valid}{more}." if valid else "")


def _from_file(path: Path | None) -> tuple[AvatarOperation, ...]:
    if path is None:
        return ()
    return _read(text_of(path), f"--operations {path}")


def _parsed(texts: Iterable[str]) -> list[AvatarOperation]:
    return [one for text in texts for one in _read(text, f"--operation {text}")]


def _read(text: str, where: str) -> tuple[AvatarOperation, ...]:
    try:
        return read_operations(text)
    except ConfigError as error:
        told = "\n".join(f"  {one}" for one in error.problems)
        raise ValueError(
            f"{where}:\n{told}\n  `reembody avatar operations` lists every operation with its keys."
        ) from None


def _problems_text(done: Edited) -> str:
    lines = ["nothing was changed:"]
    for one in done.problems:
        place = "the result" if one.operation is None else f"operation {one.operation + 1}"
        lines.append(f"  {place}: {problem_text(one.problem)}")
    return "\n".join(lines)
