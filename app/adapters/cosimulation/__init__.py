"""Partners of a co-simulation outside this process, and the files of crossing scenes.

A scene file names its partners: persons and cars of `app.science.cosimulation`, traffic by SUMO,
and any process that speaks JSON lines, of which `drive` is the example.
"""

from app.adapters.cosimulation.process_partner import ProcessPartner, ProcessPlan
from app.adapters.cosimulation.scene_file import (
    CrossingScene,
    load_scene,
    partners_of,
    partners_of_study,
    shipped_scenes,
)
from app.adapters.cosimulation.sumo_partner import SumoPartner, sumo_folder
from app.adapters.cosimulation.vehicle import VehicleOrder, drive

EXTRAS = {"traffic": ("sumo", "traci"), "fmu": ("fmpy", "pythonfmu")}
"""Extras of the package that scenes may need, with their modules: SUMO; mock-up units."""

__all__ = [
    "EXTRAS",
    "CrossingScene",
    "ProcessPartner",
    "ProcessPlan",
    "SumoPartner",
    "VehicleOrder",
    "drive",
    "load_scene",
    "partners_of",
    "partners_of_study",
    "shipped_scenes",
    "sumo_folder",
]
