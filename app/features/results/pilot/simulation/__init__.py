"""What a pilot computes: a check of the study, a cohort's visits, the power of its test.

The command and the worker processes of the server import it; the server itself does not, because it
loads the physics.
"""

from app.features.results.pilot.order import PilotError
from app.features.results.pilot.schemas import without_task
from app.features.results.pilot.simulation.check import Checked, Finding, Reached, check_study
from app.features.results.pilot.simulation.cohort import (
    Cohort,
    CohortOrder,
    merged_cohort,
    simulate_cohort,
)
from app.features.results.pilot.simulation.cohort_record import is_cohort
from app.features.results.pilot.simulation.form_texts import (
    preregistration_texts,
    reach_sentence,
    rounded,
    without_task_words,
)
from app.features.results.pilot.simulation.plan import (
    Chunk,
    PilotPlan,
    PilotStudy,
    Progress,
    Scenario,
    Sharing,
    Tell,
    chunks_of,
    lowest_p,
    make_plan,
)
from app.features.results.pilot.simulation.power import (
    Curve,
    PowerOrder,
    curve_data,
    curve_json,
    merged_curve,
    simulate_power,
)
from app.features.results.pilot.simulation.recorded_reaching import reaching_lines
from app.features.results.pilot.simulation.report import (
    PUBLISHED,
    CohortReport,
    failures_of,
    form_texts,
    paragraphs,
    report_data,
    report_on,
)
from app.features.results.pilot.simulation.simulated_study import SimulatedStudy
from app.simulated_people.visits import AvatarKind

__all__ = [
    "PUBLISHED",
    "AvatarKind",
    "Checked",
    "Chunk",
    "Cohort",
    "CohortOrder",
    "CohortReport",
    "Curve",
    "Finding",
    "PilotError",
    "PilotPlan",
    "PilotStudy",
    "PowerOrder",
    "Progress",
    "Reached",
    "Scenario",
    "Sharing",
    "SimulatedStudy",
    "Tell",
    "check_study",
    "chunks_of",
    "curve_data",
    "curve_json",
    "failures_of",
    "form_texts",
    "is_cohort",
    "lowest_p",
    "make_plan",
    "merged_cohort",
    "merged_curve",
    "paragraphs",
    "preregistration_texts",
    "reach_sentence",
    "reaching_lines",
    "report_data",
    "report_on",
    "rounded",
    "simulate_cohort",
    "simulate_power",
    "without_task",
    "without_task_words",
]
