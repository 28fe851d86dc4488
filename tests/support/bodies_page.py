"""Time frames of the participant's bodies in a browser, for the avatar of the shipped study.

`frame_times` runs them in the page, in its worker and, to compare with, by the plainest loop that
simulates the same model (`frontend/src/vr/bodies/testing`).
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from playwright.sync_api import Browser

from app.adapters.humanoids import read_humanoid
from app.features.movement.avatar.service import shipped_configurations
from app.protocol.avatar import file_of
from app.science.avatar.body import figure_of
from app.science.avatar.mjcf import avatar_model, scene_of
from app.science.tasks import TaskLayout
from tests.support.bundle import bundled

BODY = Path(__file__).parents[2] / "study_configs" / "bodies" / "neutral.glb"
Where = Literal["plain", "page", "worker"]
Times = Mapping[str, list[float]]
"""Milliseconds of every frame: `ik`, `remote`, and `page`, for which the frame loop waits."""


def shipped_avatar(layouts: tuple[TaskLayout, ...], stature_m: float = 1.75) -> dict[str, Any]:
    """Return the answer of `POST /api/vr/avatar` for the shipped configuration with its body."""
    configuration = shipped_configurations()[-1]
    figure = figure_of(read_humanoid(BODY.read_bytes()).humanoid)
    model = avatar_model(configuration, stature_m, figure=figure, scene=scene_of(layouts))
    return {
        "stature_m": stature_m,
        "mjcf": model.mjcf,
        "configuration": file_of(configuration).model_dump(mode="json"),
        "standing_hips_m": model.body.parts["Hips"].joint_m[1],
    }


def frame_times(
    browser: Browser, server_url: str, folder: Path, avatar: dict[str, Any], frames: int = 900
) -> dict[Where, Times]:
    """Return the times of as many frames each; `folder` receives the page's files.

    Only the page that simulates in its own thread ignores the server's policy, which forbids that.
    """
    bundle = bundled("vr/bodies/testing/page.ts", folder)
    strict = bundle.open(browser.new_context(), server_url, "/vr")
    loose = bundle.open(browser.new_context(bypass_csp=True), server_url, "/vr")
    run = "([answer, where, count]) => bodiesBench.frames(answer, where, count)"
    plain = "([answer, count]) => bodiesBench.plain(answer, count)"
    times: dict[Where, Times] = {
        "plain": loose.evaluate(plain, [avatar, frames]),
        "page": loose.evaluate(run, [avatar, "page", frames])["times"],
        "worker": strict.evaluate(run, [avatar, "worker", frames])["times"],
    }
    for page in (strict, loose):
        page.context.close()
    return times
