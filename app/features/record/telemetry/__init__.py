"""Telemetry: store the headset's movement and reports, read them back, and summarise phases."""

from app.features.record.telemetry.encoding import DamagedChunkError, Frames
from app.features.record.telemetry.fold import Folder
from app.features.record.telemetry.frames import (
    Piece,
    concatenate,
    decode_piece,
    epochs_of,
    iter_frames,
    iter_pieces,
)
from app.features.record.telemetry.live import LiveTelemetry, live_telemetry
from app.features.record.telemetry.movement import hinges_of
from app.features.record.telemetry.positions import (
    Outcome,
    abilities_of,
    assign_epoch,
    is_assigned_epoch,
    positions_of,
)
from app.features.record.telemetry.recovery import stop_running_clocks
from app.features.record.telemetry.summaries import Summariser
from app.features.record.telemetry.trials import NO_SESSION, TrialContent, TrialEnd
from app.features.record.telemetry.writer import (
    AlarmContent,
    Arrival,
    BatchContent,
    Content,
    LossContent,
    ProbeContent,
    TelemetryWriter,
)

__all__ = [
    "NO_SESSION",
    "AlarmContent",
    "Arrival",
    "BatchContent",
    "Content",
    "DamagedChunkError",
    "Folder",
    "Frames",
    "LiveTelemetry",
    "LossContent",
    "Outcome",
    "Piece",
    "ProbeContent",
    "Summariser",
    "TelemetryWriter",
    "TrialContent",
    "TrialEnd",
    "abilities_of",
    "assign_epoch",
    "concatenate",
    "decode_piece",
    "epochs_of",
    "hinges_of",
    "is_assigned_epoch",
    "iter_frames",
    "iter_pieces",
    "live_telemetry",
    "positions_of",
    "stop_running_clocks",
]
