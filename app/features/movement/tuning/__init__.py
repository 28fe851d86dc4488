"""Tune avatars as jobs of the server: with progress, curves, and a choice for each axis.

A tuning runs in a worker process of its own (`TuningQueue`), which can be stopped and resumed.
Curves and comparisons are computed in another one (`TuningDesk`), so that pages get answers
meanwhile. `report` has the form in which results are stored; the command `tune` uses it as well.
"""

from app.features.movement.tuning.desk import TuningDesk
from app.features.movement.tuning.report import report_json, summary_json, tuning_note
from app.features.movement.tuning.tuning_queue import TuningQueue

__all__ = ["TuningDesk", "TuningQueue", "report_json", "summary_json", "tuning_note"]
