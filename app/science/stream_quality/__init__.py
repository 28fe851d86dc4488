"""Detect faults in a stream of poses: gaps, jumps, frozen joints and invalid values.

`assess` counts the faults of a whole recording. `examine` judges each frame of a span and passes a
`Memory` from one span to the next, for streams that are still being received. Nothing is repaired.
"""

from app.science.stream_quality.examination import Examination, examine
from app.science.stream_quality.limits import DEFAULT_LIMITS, QualityError, QualityLimits
from app.science.stream_quality.memory import Memory
from app.science.stream_quality.summary import StreamQuality, assess, combine

__all__ = [
    "DEFAULT_LIMITS",
    "Examination",
    "Memory",
    "QualityError",
    "QualityLimits",
    "StreamQuality",
    "assess",
    "combine",
    "examine",
]
