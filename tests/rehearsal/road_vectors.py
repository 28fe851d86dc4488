"""Make the vectors of the road's ground: `python -m tests.rehearsal.road_vectors` writes them.

`tests/vectors/road/README.md` describes the file, which holds the headset's page to the feet of the
rehearsal's participant.
"""

import json
from pathlib import Path
from typing import Any

from app.rehearsal.road_shape import RoadShape

FILE = Path(__file__).parents[1] / "vectors" / "road" / "ground.json"
ROAD = {
    "road": {"half_length_m": 100, "lane_width_m": 2.5, "pavement_width_m": 2},
    "kerb_height_m": 0.12,
    "starts_behind_kerb_m": 0.8,
    "step_s": 0.02,
}
STEP_M, STRIDE_M = 0.05, 0.3
"""Between hips' places, and how far the feet are before and behind them."""


def make() -> dict[str, Any]:
    """Return the file's content: somebody on the way from one pavement to the other."""
    shape = RoadShape.of(ROAD)
    rows = []
    for step in range(round(8.0 / STEP_M)):
        hips_z_m = round(0.6 - step * STEP_M, 6)
        for ankle_z_m in (hips_z_m - STRIDE_M, hips_z_m, hips_z_m + STRIDE_M):
            lift_m = shape.lift_m((0.0, ankle_z_m), (0.0, hips_z_m))
            rows.append([hips_z_m, ankle_z_m, shape.sunk_m(hips_z_m), lift_m])
    return {"road": ROAD, "rows": rows}


if __name__ == "__main__":
    FILE.parent.mkdir(exist_ok=True)
    made = make()
    rows = ",\n".join(json.dumps(row) for row in made["rows"])
    FILE.write_text(f'{{"road": {json.dumps(made["road"])}, "rows": [\n{rows}\n]}}\n')
