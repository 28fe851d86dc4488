"""A wheel of known inertia on a hinge, and the relay that theory gives for it.

What the tests know, the product does not: there, torque and damping come from a push (`ramp`).
"""

from math import asin, cos, pi, tan

import mujoco

from app.science.avatar.tuning.plant import AxisPlant
from app.science.avatar.tuning.ramp import Push, ramp
from app.science.avatar.tuning.relay import (
    HYSTERESIS_RAD,
    Oscillation,
    RelaySettings,
    run_relay,
)

AMPLITUDE_HYSTERESES = 4.0


def wheel(inertia_kg_m2: float, damping_nm_s: float = 0.0) -> AxisPlant:
    """Return the model of a wheel of this inertia on a hinge of this damping."""
    inertia = f"{inertia_kg_m2} {inertia_kg_m2} {inertia_kg_m2}"
    return AxisPlant(
        mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option integrator="implicitfast"/>
          <worldbody><body>
            <inertial pos="0 0 0" mass="1" diaginertia="{inertia}"/>
            <joint type="hinge" axis="1 0 0" damping="{damping_nm_s}"/>
          </body></worldbody>
        </mujoco>""")
    )


def relay_for(inertia_kg_m2: float, frequency_hz: float) -> RelaySettings:
    """Return the relay under which a wheel oscillates at this frequency by four hystereses.

    The describing function is solved for torque and damping.
    """
    omega = 2.0 * pi * frequency_hz
    lag = asin(1.0 / AMPLITUDE_HYSTERESES)
    amplitude = AMPLITUDE_HYSTERESES * HYSTERESIS_RAD
    return RelaySettings(
        torque_nm=pi * amplitude / 4.0 * inertia_kg_m2 * omega**2 / cos(lag),
        damping_nm_s=omega * inertia_kg_m2 * tan(lag),
        step_s=1.0 / (200 * frequency_hz),
    )


def torque_shares() -> list[float]:
    """Return the motor's greatest torque in experiments on wheels, as a share of its limit."""
    shares = []
    for inertia_kg_m2, limit_nm in ((2e-4, 5.0), (0.5, 5.0), (8.0, 400.0)):
        push = ramp(wheel(inertia_kg_m2), limit_nm, 0.025)
        assert isinstance(push, Push), push
        relay = push.relay(longest_s=10.0, longest_wall_s=60.0)
        found = run_relay(wheel(inertia_kg_m2), relay, wall_s=lambda: 0.0)
        assert isinstance(found, Oscillation), found
        shares.append(found.peak_torque_nm / limit_nm)
    return shares
