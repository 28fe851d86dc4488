"""Study and instrument files: strict reading, frozen values, content hashes, plans and orders."""

from app.protocol.appearance import Appearance, Colours, Cues, Palette
from app.protocol.canonical import canonical_json, sha256_of
from app.protocol.common import Provenance, Text
from app.protocol.conditions import Condition, Orders
from app.protocol.errors import ConfigError, ConfigProblem, PlanError
from app.protocol.loading import (
    LoadedInstrument,
    LoadedStudy,
    load_instrument,
    load_study,
    parse_instrument_json,
    parse_study_json,
)
from app.protocol.orders import LedgerRow, ledger_block, sequences
from app.protocol.plan import Step, StepKind, compile_plan
from app.protocol.preregistration import ExclusionRule, Preregistration, PrimaryTest
from app.protocol.procedure import Block, ConsentStep, Procedure, SetupStep, TaskPhase
from app.protocol.safety import Safety, StopRule
from app.protocol.study import Blinding, LatencySettings, StudyProtocol
from app.protocol.tasks import FootTask, HandTask, Tasks

__all__ = [
    "Appearance",
    "Blinding",
    "Block",
    "Colours",
    "Condition",
    "ConfigError",
    "ConfigProblem",
    "ConsentStep",
    "Cues",
    "ExclusionRule",
    "FootTask",
    "HandTask",
    "LatencySettings",
    "LedgerRow",
    "LoadedInstrument",
    "LoadedStudy",
    "Orders",
    "Palette",
    "PlanError",
    "Preregistration",
    "PrimaryTest",
    "Procedure",
    "Provenance",
    "Safety",
    "SetupStep",
    "Step",
    "StepKind",
    "StopRule",
    "StudyProtocol",
    "TaskPhase",
    "Tasks",
    "Text",
    "canonical_json",
    "compile_plan",
    "ledger_block",
    "load_instrument",
    "load_study",
    "parse_instrument_json",
    "parse_study_json",
    "sequences",
    "sha256_of",
]
