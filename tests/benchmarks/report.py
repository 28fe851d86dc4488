"""Figures with units, peers or limits, and the machine on which they were measured."""

import os
import platform
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

AT_MOST, AT_LEAST = frozenset({"at most", "limit"}), frozenset({"at least"})
"""The peer names that mark a limit."""


class CannotMeasure(ValueError):
    """Raised if the requested measurement does not exist; the message names it."""


@dataclass(frozen=True)
class Figure:
    """One measured value; `peer` describes the limit, or the rival measured in the same run."""

    part: str
    name: str
    value: float
    unit: str
    peer: str = ""
    peer_value: float | None = None

    @property
    def ratio(self) -> float | None:
        """Return the value divided by the peer's."""
        return self.value / self.peer_value if self.peer_value else None

    @property
    def limit(self) -> float | None:
        """Return the limit, if the peer is one."""
        return self.peer_value if self.peer in AT_MOST | AT_LEAST else None

    @property
    def met(self) -> bool | None:
        """Return whether the value is within the limit."""
        if self.limit is None:
            return None
        # NumPy's booleans cannot be encoded as JSON.
        return bool(self.value <= self.limit if self.peer in AT_MOST else self.value >= self.limit)

    def as_json(self) -> dict[str, Any]:
        """Return the figure as values for JSON."""
        told = {"ratio": self.ratio, "limit": self.limit, "met": self.met}
        return {**asdict(self), **told}


@dataclass
class Report:
    """All figures of a run; `beside` are keys specific to this benchmark, such as `pairs`."""

    benchmark: str
    machine: dict[str, Any] = field(default_factory=lambda: machine())
    figures: list[Figure] = field(default_factory=list)
    beside: dict[str, Any] = field(default_factory=dict)

    def add(self, *figures: Figure) -> None:
        """Add figures and print each one immediately, since a run takes minutes."""
        for figure in figures:
            print(
                f"  {figure.part}: {figure.name} {figure.value:.4g} {figure.unit}", file=sys.stderr
            )
        self.figures += figures

    def as_json(self) -> dict[str, Any]:
        """Return the report as values for JSON."""
        rows = [figure.as_json() for figure in self.figures]
        head = {"benchmark": self.benchmark, "machine": self.machine}
        return {**head, **self.beside, "figures": rows}


def machine() -> dict[str, Any]:
    """Return the machine's cores, processor, Python and load at the start."""
    return {
        "cores": os.cpu_count(),
        "cpu": _cpu_name(),
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
        "load_average_1min": round(os.getloadavg()[0], 2),
    }


def as_table(report: Report) -> str:
    """Format the figures as a table, one per line."""
    rows = [["part", "figure", "value", "unit", "beside", "value", "ratio"]]
    rows += [_cells(figure) for figure in report.figures]
    widths = [max(len(row[at]) for row in rows) for at in range(len(rows[0]))]
    numbers = {2, 5, 6}
    lines = [
        "  ".join(
            cell.rjust(width) if at in numbers else cell.ljust(width)
            for at, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    about = report.machine
    head = (
        f"{report.benchmark}: {about['cores']} x {about['cpu']}, {about['system']}, "
        f"Python {about['python']}, load {about['load_average_1min']} before"
    )
    return "\n".join([head, "", *lines])


def _cells(figure: Figure) -> list[str]:
    peer = "" if figure.peer_value is None else _number(figure.peer_value)
    ratio = "" if figure.ratio is None else f"{figure.ratio:.2f}"
    value = _number(figure.value)
    return [figure.part, figure.name, value, figure.unit, figure.peer, peer, ratio]


def _number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def _cpu_name() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
