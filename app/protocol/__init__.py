"""Study and instrument files: strict parsing, frozen values, content hashes, plans and orders."""

from app.protocol.assumptions import Answering, Assumptions, Performance, declared_analysis
from app.protocol.avatar_changes import (
    MAX_FACTOR,
    AvatarChanges,
    change_problems,
    driven_axes_of,
    settings_in_force,
)
from app.protocol.common import Text, canonical_json, sha256_of
from app.protocol.conditions import BodyName, Condition
from app.protocol.difference import differences
from app.protocol.durations import (
    BY_HAND_S,
    ITEM_S,
    OPENING_S,
    READING_WORDS_PER_S,
    TimedStep,
    VisitTime,
    form_s,
    planned_s,
    timeline,
    total_s,
    visit_time,
)
from app.protocol.errors import ConfigError, ConfigProblem, PlanError
from app.protocol.explanations import did_you_mean, explain
from app.protocol.loading import (
    LoadedAssumptions,
    LoadedInstrument,
    LoadedStudy,
    instrument_as_json,
    load_assumptions,
    load_instrument,
    load_study,
    parse_instrument_json,
    parse_study_json,
    study_schema,
)
from app.protocol.orders import LedgerRow, imbalances, ledger_block, sequences
from app.protocol.plan import Step, compile_plan
from app.protocol.preregistration import ExclusionRule, Preregistration, PrimaryTest
from app.protocol.procedure import ConsentStep, FormPlace
from app.protocol.safety import StopRule
from app.protocol.source import MAX_FILE_BYTES, Path, Plain, Source, path_text, read_source
from app.protocol.step_kinds import (
    BOX_KINDS,
    COUNTED_KINDS,
    FORM_KINDS,
    PHASES,
    STEP_KINDS,
    TIMED_KINDS,
    UNCOUNTED_KINDS,
    StepKind,
    StepKindSpec,
    kinds_with_command,
    step_kind_texts,
    step_kinds_for_pages,
)
from app.protocol.study import StudyProtocol
from app.protocol.tasks import Tasks
from app.protocol.validity import LatencyRule, ValidWhen

__all__ = [
    "BOX_KINDS",
    "BY_HAND_S",
    "COUNTED_KINDS",
    "FORM_KINDS",
    "ITEM_S",
    "MAX_FACTOR",
    "MAX_FILE_BYTES",
    "OPENING_S",
    "PHASES",
    "READING_WORDS_PER_S",
    "STEP_KINDS",
    "TIMED_KINDS",
    "UNCOUNTED_KINDS",
    "Answering",
    "Assumptions",
    "AvatarChanges",
    "BodyName",
    "Condition",
    "ConfigError",
    "ConfigProblem",
    "ConsentStep",
    "ExclusionRule",
    "FormPlace",
    "LatencyRule",
    "LedgerRow",
    "LoadedAssumptions",
    "LoadedInstrument",
    "LoadedStudy",
    "Path",
    "Performance",
    "Plain",
    "PlanError",
    "Preregistration",
    "PrimaryTest",
    "Source",
    "Step",
    "StepKind",
    "StepKindSpec",
    "StopRule",
    "StudyProtocol",
    "Tasks",
    "Text",
    "TimedStep",
    "ValidWhen",
    "VisitTime",
    "canonical_json",
    "change_problems",
    "compile_plan",
    "declared_analysis",
    "did_you_mean",
    "differences",
    "driven_axes_of",
    "explain",
    "form_s",
    "imbalances",
    "instrument_as_json",
    "kinds_with_command",
    "ledger_block",
    "load_assumptions",
    "load_instrument",
    "load_study",
    "parse_instrument_json",
    "parse_study_json",
    "path_text",
    "planned_s",
    "read_source",
    "sequences",
    "settings_in_force",
    "sha256_of",
    "step_kind_texts",
    "step_kinds_for_pages",
    "study_schema",
    "timeline",
    "total_s",
    "visit_time",
]
