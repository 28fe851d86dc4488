"""The table of calibrations: of the lab's equipment, so it belongs to no session."""

import pandas as pd
from sqlalchemy.orm import Session

from app.features.record.calibrations import calibrations
from app.features.results.analysis.tables.context import finished


def calibrations_table(db: Session) -> pd.DataFrame:
    """One row per measurement, by equipment, the newest first; retired ones are included."""
    rows = [view.model_dump() for view in calibrations(db)]
    names = ("equipment", "motion_to_photon_ms", "sd_ms", "samples", "method", "measured_on")
    more = ("current", "note", "at", "retired_at", "retired_reason")
    frame = pd.DataFrame(rows, columns=[*names, *more], dtype=object)
    frame["measured_on"] = [day.isoformat() for day in frame["measured_on"]]
    renamed = {"at": "recorded_at_utc", "retired_at": "retired_at_utc"}
    return finished(frame.rename(columns=renamed), "calibrations")
