"""What is wrong with a stream of poses: gaps, jumps, frozen joints, values that are none.

`assess` counts the faults of a whole recording. `examine` judges frame by frame and carries a
`Memory` from one span to the next, for streams that are still coming. Nothing is repaired.
"""

from app.science.stream_quality.examination import Examination, examine
from app.science.stream_quality.limits import USUAL, QualityError, QualityLimits
from app.science.stream_quality.memory import Memory
from app.science.stream_quality.summary import StreamQuality, assess, together

__all__ = [
    "USUAL",
    "Examination",
    "Memory",
    "QualityError",
    "QualityLimits",
    "StreamQuality",
    "assess",
    "examine",
    "together",
]
