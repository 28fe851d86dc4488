"""The body of a simulated person: sex, stature, mass, age, and which hand and foot they prefer.

| quantity | distribution | source |
|---|---|---|
| sex | half women, half men | assumed |
| stature of women | normal, 1.621 m, SD 0.0626 m | 5th percentile 1.518 m (Huston), mean assumed |
| stature of men | normal, 1.755 m, SD 0.0693 m | 95th percentile 1.869 m (Huston), mean assumed |
| body mass index | log-normal, median 23.5 kg/m2, SD of its log 0.14 | assumed |
| age | uniform, 19 to 44 years | assumed |
| writing hand | left in 10.6 % | Papadatou-Pastou et al. 2020, Psychological Bulletin 146:481 |
| foot | as the hand in 80 %, else the other or both, equally | assumed |

Huston 2009: Principles of Biomechanics, chapter 2. Statures are limited to what an avatar can be
built for, 1.40 to 2.10 m. A study's avatar has the mass of its configuration, not the person's.
"""

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

_STATURES_M: Final = {"female": (1.621, 0.0626), "male": (1.755, 0.0693)}
_LEAST_M, _MOST_M = 1.40, 2.10
_INDEX_KG_M2, _INDEX_SPREAD = 23.5, 0.14
_LEFT_HANDED = 0.106
_SAME_FOOT, _OTHER_FOOT = 0.8, 0.9
_YOUNGEST, _OLDEST = 19, 44

Sex = Literal["female", "male"]
Hand = Literal["left", "right"]
Foot = Literal["left", "right", "both"]


@dataclass(frozen=True)
class Build:
    """What a simulated person is like; `mass_kg` is their own, `age` in years."""

    sex: Sex
    stature_m: float
    mass_kg: float
    age: int
    handedness: Hand
    footedness: Foot


def draw_build(rng: np.random.Generator) -> Build:
    """Draw one person."""
    sex: Sex = "female" if rng.random() < 0.5 else "male"
    mean_m, spread_m = _STATURES_M[sex]
    stature_m = min(max(mean_m + spread_m * float(rng.standard_normal()), _LEAST_M), _MOST_M)
    index = _INDEX_KG_M2 * math.exp(_INDEX_SPREAD * float(rng.standard_normal()))
    hand: Hand = "left" if rng.random() < _LEFT_HANDED else "right"
    other: Hand = "right" if hand == "left" else "left"
    drawn = rng.random()
    foot: Foot = hand if drawn < _SAME_FOOT else other if drawn < _OTHER_FOOT else "both"
    return Build(
        sex=sex,
        stature_m=stature_m,
        mass_kg=index * stature_m**2,
        age=int(rng.integers(_YOUNGEST, _OLDEST + 1)),
        handedness=hand,
        footedness=foot,
    )
