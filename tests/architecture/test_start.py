"""A test of what a start of the server loads."""

import subprocess
import sys

HEAVY = (
    *("DracoPy", "llvmlite", "mujoco", "numba", "pandas", "plotly", "scipy", "statsmodels"),
    *("PIL", "kaleido", "matplotlib", "pyarrow", "reportlab"),
)
"""Packages that only computations need, which run in processes of their own, or that are extras."""
LOADS = f"""
import sys
import app.cli.serve.run, uvicorn.protocols.http.httptools_impl
from app.main import create_app
from app.settings import Settings
create_app(Settings(database_url="sqlite://"))
print(sorted(set({HEAVY!r}) & set(sys.modules)))
"""


def test_a_start_of_the_server_loads_no_heavy_package() -> None:
    """What `reembody serve` loads contains no package that only computations or extras need."""
    result = subprocess.run(
        [sys.executable, "-c", LOADS], capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"
