"""Builders of the avatar's bodies and MuJoCo models for tests."""

import mujoco

from app.science.avatar.body.body import Body
from app.science.avatar.body.masses import body_masses
from app.science.avatar.body.parts import FINGER_PARTS, PART_NAMES
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.model_options import ModelOptions
from app.science.avatar.mjcf.gains import default_settings
from app.science.avatar.mjcf.mjcf import build_mjcf
from app.science.avatar.mjcf.scene import Scene, scene_of
from app.science.tasks.layout import BlockSpec, BoxSpec, Limb, build_layout

NO_FINGERS = [part for part in PART_NAMES if part not in FINGER_PARTS]
EMPTY = Scene(floor=False)
CARRIED, WELDED = ModelOptions(hips="carried"), ModelOptions(hips="welded")
STUDY_BOXES = scene_of(
    [
        build_layout(
            Limb.HAND,
            (
                BoxSpec(1, (-0.3, 1.1, -0.5), (0.3, 0.3, 0.3)),
                BoxSpec(2, (0.3, 1.1, -0.5), (0.3,) * 3),
            ),
            BlockSpec((0.0, 1.6, -0.4), (0.1, 0.1, 0.1)),
            wall_thickness_m=0.01,
            panel_thickness_m=0.01,
            reverse_after_task=True,
        ),
        build_layout(
            Limb.FOOT,
            (BoxSpec(1, (0.0, 0.1, -0.6), (0.3, 0.2, 0.3)),),
            BlockSpec((0.0, 0.05, -1.2), (0.6, 0.1, 0.1)),
            wall_thickness_m=0.01,
            panel_thickness_m=0.005,
            reverse_after_task=False,
            start_square=BlockSpec((0.0, 0.0025, 0.0), (0.45, 0.005, 0.45)),
        ),
    ]
)


def mjcf_of(
    body: Body,
    *,
    settings: dict[str, AxisSettings] | None = None,
    scene: Scene = EMPTY,
    options: ModelOptions | None = None,
) -> str:
    """Return the MJCF of a body of 72 kg, by default in an empty room without a floor."""
    masses = body_masses(body, 72.0)
    chosen = default_settings(body, masses) if settings is None else settings
    return build_mjcf(body, masses, chosen, scene=scene, options=options or ModelOptions())


def loaded(text: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Load an MJCF and return the model with its data in the initial state."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def settings_of(body: Body, *, free: bool = False) -> dict[str, AxisSettings]:
    """Return the default axis settings of a body of 72 kg."""
    return default_settings(body, body_masses(body, 72.0), preset="free" if free else "anatomic")


def warnings_of(data: mujoco.MjData) -> int:
    """Return the number of warnings that MuJoCo has raised."""
    return sum(int(warning.number) for warning in data.warning)
