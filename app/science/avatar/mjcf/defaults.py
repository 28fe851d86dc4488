"""The configuration that comes with the product.

Limits are a human body's; gains and torques follow from what each axis moves in a body of average
stature and mass. A relay tuning finds better ones for a certain body, and is saved beside this.
"""

from typing import Final

from app.science.avatar.body import body_masses, build_body
from app.science.avatar.configuration import USUAL_MASS_KG, Configuration, Preset
from app.science.avatar.mjcf.gains import default_settings

USUAL_STATURE_M: Final = 1.75


def default_configuration(*, limits: Preset = "anatomic") -> Configuration:
    """Every axis of the whole body; `free` lets the elbow turn about its third axis."""
    body = build_body(USUAL_STATURE_M)
    masses = body_masses(body, USUAL_MASS_KG)
    return Configuration(default_settings(body, masses, preset=limits))
