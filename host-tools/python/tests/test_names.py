"""Every public callable, with every argument wrong in many ways: what is raised names the argument."""

import functools
import inspect
import math
import tempfile

import numpy as np
import pytest
import tendon_leg
from tendon_leg import AsyncLeg, FileRefused, Leg, LegError, Rig, SimulatedLeg, campaign, run_scenario


class Number:
    """Of no kind that is known."""


#: For each argument one that is right, where it is not left out.
RIGHT = {
    "azimuth_deg": 0.0,
    "tilt_deg": 5.0,
    "nm_per_rad": 100.0,
    "newtons": 70.0,
    "points": [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0]],
    "seconds": 0.01,
    "kg": 1.0,
    "force_n": 1.0,
    "for_s": 0.1,
    "fault": "cell_dead",
    "tendon": 1,
    "pressed": False,
    "silent": False,
    "load": "estimated",
    "name": "tilt_deg",
    "signals": ["tilt_deg"],
    "text": Rig().text,
    "values": Rig().to_dict(),
    "tensions_n": [50.0],
    "scenario": "hold",
    "interface": "can9",
    "port": "/dev/nope",
    "action": {"payload": {"kg": 1}},
    "rig": "table1",
    "cell": 1,
    "motor": 1,
    "travel_mm": 1.0,
    "weights_kg": [0, 1],
    "hang": lambda kg: None,
    "turn": lambda motor: None,
    "cases": [],
    "directory": tempfile.mkdtemp(),
}

#: What is wrong for every argument.
WRONG = [Number(), 1j, "\udc80", np.array([1 + 1j]), np.complex64(1)]

#: What is wrong for numbers, and may be right for others.
NO_NUMBERS = [10**400, -(10**30), math.nan, math.inf, -1e300, b"1", "1", [[[1]]], np.array(["1"]), np.datetime64("2026-01-01"), {}, None]


def armed():
    leg = SimulatedLeg()
    leg.arm()
    return leg


def called(new, method, /, **given):
    return getattr(new(), method)(**given)


def walk():
    """Each callable with how it is called on something new, and its arguments."""
    for class_, new in ((Rig, Rig), (SimulatedLeg, armed), (Leg, Leg.emulated)):
        for name, member in vars(class_).items():
            if name.startswith("_") or not callable(getattr(class_, name)):
                continue
            if isinstance(member, staticmethod):
                yield f"{class_.__name__}.{name}", getattr(class_, name)
            else:
                yield f"{class_.__name__}.{name}", functools.partial(called, new, name)
    yield "Rig", Rig
    yield "SimulatedLeg", SimulatedLeg
    yield "run_scenario", run_scenario
    yield "campaign", campaign


def parameters(name):
    of = tendon_leg
    for part in name.split("."):
        of = getattr(of, part)
    return [each for each in inspect.signature(of).parameters.values() if each.name != "self"]


CALLS = [(name, call, each.name) for name, call in walk() for each in parameters(name)]


@pytest.mark.parametrize(("name", "call", "wrong"), CALLS, ids=[f"{name}({wrong})" for name, _, wrong in CALLS])
def test_an_argument_that_is_wrong_is_named(name, call, wrong, monkeypatch, tmp_path):
    # Some of what is given is a directory.
    monkeypatch.chdir(tmp_path)
    given = {each.name: RIGHT[each.name] for each in parameters(name) if each.default is each.empty}
    if name in ("SimulatedLeg.fault", "SimulatedLeg.repair"):
        given["tendon"] = 1
    if "towards" in wrong:
        stiffness = {"Rig.evaluate": "demand_nm_per_rad", "Leg.move": "stiffness_nm_per_rad"}
        given |= {stiffness[name]: 100.0} if name in stiffness else {}
    of_own = [each for each in parameters(name) if each.name == wrong and each.default is None]
    refused = 0
    for value in WRONG + NO_NUMBERS:
        if value is None and of_own:
            continue
        try:
            call(**{**given, wrong: value})
        except (ValueError, TypeError, LegError) as error:
            refused += 1
            # A name that is none is refused with what it names: a port, a rig, a scenario. A rig file is refused at its place.
            named = wrong in str(error) or str(value) in str(error) or isinstance(error, FileRefused)
            assert named, f"{value!r}: {type(error).__name__}: {error}"
    assert refused >= 2


def test_all_that_is_public_was_walked_over():
    walked = {name.split(".")[0] for name, _ in walk()}
    public = {name for name in tendon_leg.__all__ if callable(getattr(tendon_leg, name))}
    errors = {name for name in public if isinstance(getattr(tendon_leg, name), type) and issubclass(getattr(tendon_leg, name), Exception)}
    assert public - errors == walked | {"AsyncLeg", "Leg"}
    # The arguments of `AsyncLeg` are those of `Leg`.
    for name, member in vars(AsyncLeg).items():
        if not name.startswith("_"):
            assert parameters(f"AsyncLeg.{name}") == parameters(f"Leg.{name}"), name
