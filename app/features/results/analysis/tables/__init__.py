"""Read the record as tidy tables: SQL in, pandas data frames out, one function per table.

Every function takes a study and a kind (people, simulated, test or all) and returns a DataFrame
whose columns are those of the codebook, in their order. No row is left out: redone phases,
superseded forms, broken-off sessions and sessions that are not valid by their study's rules are
included with `valid` false. Texts are `object`, integers `Int64`, numbers `float64`, booleans
`bool` (`boolean` if one is missing), times `datetime64[us, UTC]`; missing values are NA.
"""

from app.features.results.analysis.schemas import Kind
from app.features.results.analysis.tables.clocks import run_clocks
from app.features.results.analysis.tables.context import (
    KINDS,
    Contexts,
    has_rules,
    of_kind,
    shared_contexts,
)
from app.features.results.analysis.tables.equipment import (
    calibrations_table,
    clock_mapping_table,
    clock_probes_table,
    headset_tests_table,
)
from app.features.results.analysis.tables.headset import body_calibrations_table, goal_states_table
from app.features.results.analysis.tables.joint_errors import (
    joint_angles_table,
    joint_error_course_table,
    joint_errors_table,
    present_course_table,
)
from app.features.results.analysis.tables.phases import (
    alarms_table,
    doubts_table,
    phases_table,
    quality_table,
)
from app.features.results.analysis.tables.questionnaires import (
    answers_table,
    corrections_table,
    scores_table,
)
from app.features.results.analysis.tables.road import road_crossings_table, road_records
from app.features.results.analysis.tables.sessions import events_table, n_not_valid, sessions_table
from app.features.results.analysis.tables.tasks import (
    completions_table,
    contact_spans_table,
    contacts_table,
)
from app.features.results.analysis.tables.trackers import (
    companion_frames,
    has_companion_frames,
    has_tracker_samples,
    tracker_alignments_table,
    tracker_samples,
)

__all__ = [
    "KINDS",
    "Contexts",
    "Kind",
    "alarms_table",
    "answers_table",
    "body_calibrations_table",
    "calibrations_table",
    "clock_mapping_table",
    "clock_probes_table",
    "companion_frames",
    "completions_table",
    "contact_spans_table",
    "contacts_table",
    "corrections_table",
    "doubts_table",
    "events_table",
    "goal_states_table",
    "has_companion_frames",
    "has_rules",
    "has_tracker_samples",
    "headset_tests_table",
    "joint_angles_table",
    "joint_error_course_table",
    "joint_errors_table",
    "n_not_valid",
    "of_kind",
    "phases_table",
    "present_course_table",
    "quality_table",
    "road_crossings_table",
    "road_records",
    "run_clocks",
    "scores_table",
    "sessions_table",
    "shared_contexts",
    "tracker_alignments_table",
    "tracker_samples",
]
