"""Tests that the page's request, the command and Python edit made-up configurations alike.

What the page computes itself is held to Python by `tests/vectors/avatar/edits.json`.
"""

import json
from collections.abc import Iterable
from pathlib import Path

import pytest

from app.cli.avatar.library import Installation
from app.cli.avatar.run import EditOrder
from app.cli.avatar.run import edit as carry_out
from app.protocol.avatar import avatar_text, content_of, file_of, load_avatar, loaded
from app.protocol.avatar_editing import edited, fits_single_template, read_operations
from app.science.avatar.configuration import Configuration
from tests.features.lab import Json, Lab, ok
from tests.protocol.made_up_operations import EVERYTHING, made_up_operations
from tests.science.avatar.configurations import made_up

SHORT, LONG = 15, 1_000
PATH = "/api/avatars/edit"


@pytest.mark.one_engine
def test_page_command_and_python_edit_alike(fresh_lab: Lab, tmp_path: Path) -> None:
    """Operations of every kind have the same result, or the same problems, in all three ways."""
    refused, kinds = edit_in_three_ways(fresh_lab, tmp_path, range(SHORT))
    assert 0 < refused < SHORT / 2
    assert len(kinds) > 10


@pytest.mark.long
@pytest.mark.one_engine
def test_page_command_and_python_edit_a_thousand_alike(fresh_lab: Lab, tmp_path: Path) -> None:
    """The same holds for a thousand configurations, with every kind of operation."""
    refused, kinds = edit_in_three_ways(fresh_lab, tmp_path, range(LONG))
    assert 0 < refused < LONG / 2
    assert len(kinds) == 17


def edit_in_three_ways(lab: Lab, folder: Path, seeds: Iterable[int]) -> tuple[int, set[str]]:
    """Edit configurations in all three ways; return how many were refused, and what was done."""
    refused, kinds = 0, set[str]()
    for seed in seeds:
        before = made_up(seed)
        operations = made_up_operations(before, seed)
        here = edited(before, read_operations(json.dumps(operations)), _no_version)
        page = on_page(lab, before, *operations)
        problems = [(one.operation, one.problem.message) for one in here.problems]
        by_command = commanded(folder, before, operations)
        if problems:
            refused += 1
            told = [(one["operation"], one["message"]) for one in page["problems"]]
            assert told == problems, seed
            assert isinstance(by_command, str)
            assert all(message in by_command for _, message in problems), seed
            assert page["configuration"] == as_page(before)
            continue
        kinds.update(one["operation"] for one in operations)
        content = loaded(here.configuration)
        assert not isinstance(by_command, str), by_command
        assert page["content_hash"] == by_command["content_hash"] == content.content_hash, seed
        assert (folder / "out.json").read_text() == avatar_text(here.configuration)
        assert page["changed"] == by_command["changed"]
        assert page["lost"] == by_command["lost"]
        # The page's table of one joint per part says what a conversion would keep.
        assert page["fits_single_template"] == fits_single_template(here.configuration)
        # Undo: the page returns to the state that it had, which the server holds to be the same.
        undo = {"operation": "load", "configuration": content_of(before), "what": EVERYTHING}
        undone = on_page(lab, here.configuration, undo)
        assert undone["content_hash"] == loaded(before).content_hash, seed
        assert avatar_text(load_avatar(json.dumps(undone["configuration"])).configuration) == (
            avatar_text(before)
        )
    return refused, kinds


def on_page(lab: Lab, configuration: Configuration, *operations: Json) -> Json:
    """Return the answer to the page's request."""
    body = {"configuration": as_page(configuration), "operations": list(operations)}
    answer: Json = ok(lab.operator.post(PATH, json=body))
    missing = "No body can be built without"
    # Made-up bodies lack parts, which the page may try, but not save.
    answer["problems"] = [one for one in answer["problems"] if missing not in one["message"]]
    return answer


def as_page(configuration: Configuration) -> Json:
    """Return a configuration as the page has it."""
    file: Json = file_of(configuration).model_dump(mode="json")
    return file


def commanded(folder: Path, configuration: Configuration, operations: list[Json]) -> Json | str:
    """Return the result of the command, or the words with which it refuses."""
    source, listed = folder / "source.json", folder / "operations.json"
    source.write_text(avatar_text(configuration))
    listed.write_text(json.dumps(operations))
    order = EditOrder(str(source), (), listed, folder / "out.json", None, None, "", None)
    try:
        return carry_out(Installation(), order).as_json
    except ValueError as error:
        return str(error)


def _no_version(key: str, _: int | None) -> Configuration:
    raise AssertionError(key)
