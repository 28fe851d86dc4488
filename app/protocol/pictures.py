"""The pictures that texts of a study can show on the tablet: `![t_pose]`, alone between two lines.

The product draws them; `frontend/src/shared/pictures.ts` has the same names.
"""

import re
from collections.abc import Iterator, Mapping

from app.protocol.source import Path
from app.science.instruments import DefinitionProblem

PICTURES = ("equipment", "t_pose", "mirror", "hand_boxes", "foot_boxes")
_WANTED = re.compile(r"^\s*!\[([^\]\n]*)\]\s*$", re.MULTILINE)


def picture_problems(path: Path, wordings: Mapping[str, str]) -> Iterator[DefinitionProblem]:
    """A name that is no picture's would leave a hole in the instructions."""
    for language, words in wordings.items():
        for name in _WANTED.findall(words):
            if name not in PICTURES:
                yield DefinitionProblem(
                    (*path, language),
                    f"There is no picture {name!r}.",
                    name,
                    list(PICTURES),
                    f"Use one of: {', '.join(PICTURES)}; or take the line out.",
                )
