"""The controller for tendon-driven legs, in Python: the model, a leg simulated with the firmware's own code, many scenarios
at once, and a leg on a port.

>>> from tendon_leg import SimulatedLeg
>>> leg = SimulatedLeg("table1", payload_kg=1.0)
>>> leg.arm()
>>> leg.move(azimuth_deg=30, tilt_deg=20)
>>> round(leg.truth()["tilt_true_deg"], 1)
20.0
"""

from ._native import (
    DEFECTS,
    OUTPUTS,
    READY_RIGS,
    READY_SCENARIOS,
    SIGNALS,
    STATES,
    TICKS_PER_SECOND,
    Leg,
    Rig,
    SimulatedLeg,
    run_scenario,
)
from .aio import AsyncLeg
from .campaign import campaign
from .errors import FileRefused, LegError, LegFault, LegTimeout, NoResult, Refused, RigError, ScenarioError

__all__ = [
    "DEFECTS",
    "OUTPUTS",
    "READY_RIGS",
    "READY_SCENARIOS",
    "SIGNALS",
    "STATES",
    "TICKS_PER_SECOND",
    "AsyncLeg",
    "FileRefused",
    "Leg",
    "LegError",
    "LegFault",
    "LegTimeout",
    "NoResult",
    "Refused",
    "Rig",
    "RigError",
    "ScenarioError",
    "SimulatedLeg",
    "campaign",
    "run_scenario",
]
