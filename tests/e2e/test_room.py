"""The headset's room: what drawing it for an eye takes, and what its mirror shows."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray

from tests.support.browser import ContextFactory
from tests.support.room import ACCOMPANIED, EVERYTHING, IN_FRONT, MOMENTS, PAUSED, ROOT, opened_room

MOST_CALLS, MOST_TRIANGLES = 20, 100_000
STUDY = ROOT / "study_configs/reembodiment-latency.yaml"


@pytest.fixture(scope="module")
def study() -> dict[str, Any]:
    """Provide the shipped study's file."""
    read: dict[str, Any] = yaml.safe_load(STUDY.read_text())
    return read


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Provide the folder of the page's bundle, made once for all tests."""
    return tmp_path_factory.mktemp("room")


def _is_skin(pixels: NDArray[np.int16], at: tuple[float, float]) -> bool:
    """Return whether the picture has the shipped figure's skin around a pixel."""
    x, y = round(at[0]), round(at[1])
    red, green, blue = pixels[y - 1 : y + 2, x - 1 : x + 2].reshape(-1, 3).mean(axis=0)
    return bool(red > green + 15 > blue + 25)


# `./run bench vr --only mirror` counts the same; drawing it without a graphics card takes minutes.
@pytest.mark.long
def test_an_eye_takes_few_draw_calls_and_never_changes_its_target(
    new_context: ContextFactory, study: dict[str, Any], bundle: Path
) -> None:
    """Everything that can be seen at once takes at most 20 draw calls, into one framebuffer."""
    with opened_room(new_context(), bundle, study) as room:
        drawn = room.draw_fading(EVERYTHING)
        without = room.draw_fading({**EVERYTHING, "panel": None})
        stopping = room.draw_fading({**EVERYTHING, "panel": "stopping"})
        beside = room.draw_fading(ACCOMPANIED)
        paused = room.draw_fading(PAUSED)

        assert max(drawn.calls, stopping.calls, beside.calls) <= MOST_CALLS
        assert min(drawn.calls, stopping.calls) > without.calls
        assert paused.calls < without.calls
        assert 20_000 < drawn.triangles <= MOST_TRIANGLES
        assert beside.triangles <= MOST_TRIANGLES
        assert drawn.target_switches == 0


def test_the_head_is_in_the_glass_and_not_before_the_eyes(
    new_context: ContextFactory, study: dict[str, Any], bundle: Path
) -> None:
    """Both eyes see the wearer's head in the mirror; where the head itself is, nothing is drawn."""
    with opened_room(new_context(), bundle, study) as room:
        looking = room.draw(MOMENTS["mirror"])
        in_front = room.draw(IN_FRONT)

    for eye in (0, 1):
        assert _is_skin(looking.pixels, looking.reflected_heads_px[eye])
        assert not _is_skin(in_front.pixels, in_front.heads_px[eye])


def test_the_mirror_shows_what_threes_reflector_shows(
    new_context: ContextFactory, study: dict[str, Any], bundle: Path
) -> None:
    """In each eye at most 0.5 % of the pixels differ by more than 24 of 255."""
    pictures = {}
    for mirror in ("double", "reflector"):
        with opened_room(new_context(), bundle, study, mirror=mirror) as room:
            pictures[mirror] = room.draw(MOMENTS["free_roam"])

    for eye in (0, 1):
        apart = np.abs(pictures["double"].eye(eye) - pictures["reflector"].eye(eye)).max(axis=2)
        assert (apart > 24).mean() <= 0.005
    # The comparison is with a mirror that is drawn in the middle of the pass.
    assert pictures["reflector"].target_switches > pictures["double"].target_switches == 0
