"""Rules that turn the measurements of a relay experiment into the gains kp and kd.

A rule takes either kp as a share of Ku, with kd = kp Td and Td a share of Pu, or both from the
inertia. A limb is nearly a double integrator: for it Ku is about I w^2, so a share of .8 with Td =
.356 Pu is critical damping, at a natural frequency just under the relay's. The classical rules are
meant for self-damping processes and have an integral term, which an avatar does not have; they
overshoot.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from types import MappingProxyType
from typing import Final

from app.science.avatar.tuning.relay import Oscillation


@dataclass(frozen=True)
class Gains:
    """The gains of one axis: stiffness kp in N m/rad and damping kd in N m s/rad."""

    kp: float
    kd: float


@dataclass(frozen=True)
class Heuristic:
    """A rule that computes gains from the measured oscillation of an axis.

    Attributes:
        key: the key by which the rule is chosen.
        source: the publication, or how it was derived.
        kp_per_ku: kp as a share of the ultimate gain; None for rules that use the inertia.
        td_per_pu: kd / kp as a share of the period.
        damping_ratio: zeta, for rules that use the inertia: kp = I w^2, kd = 2 zeta I w.
    """

    key: str
    source: str
    kp_per_ku: float | None = None
    td_per_pu: float = 0.0
    damping_ratio: float = 1.0

    def gains(self, found: Oscillation, natural_hz: float) -> Gains:
        """Return the gains; rules that use the inertia give the axis this natural frequency."""
        if self.kp_per_ku is not None:
            kp = self.kp_per_ku * found.ultimate_gain_nm_rad
            return Gains(_rounded(kp), _rounded(kp * self.td_per_pu * found.period_s))
        omega = 2.0 * pi * natural_hz
        inertia = found.inertia_kg_m2
        return Gains(
            _rounded(omega**2 * inertia), _rounded(2.0 * self.damping_ratio * omega * inertia)
        )


HEURISTICS: Final[Mapping[str, Heuristic]] = MappingProxyType(
    {
        rule.key: rule
        for rule in (
            Heuristic(
                "critical",
                "ours: critical damping of a double integrator",
                kp_per_ku=0.8,
                td_per_pu=0.356,
            ),
            Heuristic(
                "inertia",
                "ours: critical damping at a chosen frequency, from the measured inertia",
            ),
            Heuristic(
                "ziegler-nichols-pd",
                "Ziegler and Nichols 1942, Trans. ASME 64, 759-768, without an integral part",
                kp_per_ku=0.8,
                td_per_pu=0.125,
            ),
            Heuristic(
                "tyreus-luyben-pd",
                "Tyreus and Luyben 1992, Ind. Eng. Chem. Res. 31, 2625-2628, without an integral"
                " part",
                kp_per_ku=1.0 / 3.2,
                td_per_pu=1.0 / 6.3,
            ),
        )
    }
)
"""The rules by key; the first is the default."""


def _rounded(value: float) -> float:
    """Round to six significant digits, as in the default configuration."""
    return float(f"{value:.6g}")
