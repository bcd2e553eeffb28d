"""Whatever is given is refused by name, and never ends the interpreter."""

import math
import random
from pathlib import Path

import numpy as np
import pytest
from tendon_leg import DEFECTS, LegError, RigError, ScenarioError, SimulatedLeg, run_scenario

NAN, INFINITY = math.nan, math.inf

LINE = [[0, 0, 0], [1, 0, 1], [2, 0, 2]]


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda leg: leg.move(NAN, 3), ValueError, "azimuth_deg = NaN is not a finite number"),
        (lambda leg: leg.move(0, INFINITY), ValueError, "tilt_deg = inf is not a finite number"),
        (lambda leg: leg.move(0, 95), ValueError, "tilt_deg = 95 is not from -90 to 90"),
        (lambda leg: leg.move("a", 3), TypeError, "azimuth_deg"),
        (lambda leg: leg.follow([[1, 2], [3, 4]]), ValueError, "points has the shape [2, 2], not (n, 3)"),
        (lambda leg: leg.follow(np.zeros((5, 3))), ValueError, "points has the time 0 s at index 1"),
        (lambda leg: leg.follow([[0, 0, 0]]), ValueError, "points has the shape [1, 3]"),
        (lambda leg: leg.follow([[0, 0, 0], [1, NAN, 0]]), ValueError, "points holds NaN at index 4"),
        (lambda leg: leg.follow(LINE, pretension_n=[60, 70]), ValueError, "one for each of the 3 rows"),
        (lambda leg: leg.follow(LINE, pretension_n=[60, -1, 70]), ValueError, "pretension_n holds -1 at index 1"),
        (lambda leg: leg.follow(LINE, stiffness_nm_per_rad=0), ValueError, "stiffness_nm_per_rad holds 0 at index 0"),
        (lambda leg: leg.follow(LINE, pretension_n=NAN), ValueError, "pretension_n holds NaN"),
        (lambda leg: leg.follow(LINE, pretension_n="x"), TypeError, "pretension_n is no array of numbers"),
        (
            lambda leg: leg.follow(LINE, pretension_n=60, stiffness_nm_per_rad=60),
            ValueError,
            "pretension_n and stiffness_nm_per_rad are given; give one of them",
        ),
        (lambda leg: leg.follow("x"), TypeError, "points is no array of numbers"),
        (lambda leg: leg.follow([[0, 0, 0], [1, 0]]), TypeError, "points is no array of numbers"),
        (lambda leg: leg.follow([[0, 0, 0], [1, 0, 91]]), ValueError, "tilt 91° at index 1"),
        (lambda leg: leg.step(-1), ValueError, "ticks = -1 is not from 0"),
        (lambda leg: leg.step(10**12), ValueError, "ticks = 1000000000000 is not"),
        (lambda leg: leg.step(10**30), ValueError, "ticks = 1000000000000000000000000000000 is not"),
        (lambda leg: leg.run(NAN), ValueError, "seconds = NaN"),
        (lambda leg: leg.run(-1), ValueError, "seconds = -1 is not from 0"),
        (lambda leg: leg.wait(1e9), ValueError, "timeout_s = 1000000000 is not"),
        (lambda leg: leg.payload(-1), ValueError, "kg = -1 is not from 0 to 50"),
        (lambda leg: leg.payload(1, NAN), ValueError, "over_s = NaN"),
        (lambda leg: leg.push(0, 1, -1), ValueError, "for_s = -1 is not from 0"),
        (lambda leg: leg.stiffness(NAN), ValueError, "nm_per_rad = NaN"),
        (lambda leg: leg.stiffness(100, INFINITY), ValueError, "towards_deg = inf"),
        (lambda leg: leg.pretension(NAN), ValueError, "newtons = NaN"),
        (lambda leg: leg.compensation("on"), ValueError, 'load = "on" is none of'),
        (lambda leg: leg.fault("nope"), ValueError, 'fault = "nope" is no defect'),
        (lambda leg: leg.fault("cell_dead"), ValueError, "tendon is not given"),
        (lambda leg: leg.fault("cell_dead", 4), ValueError, "tendon = 4 is none of 1, 2 and 3"),
        (lambda leg: leg.fault("supply_sag", 1), ValueError, "tendon is given"),
        (lambda leg: leg.read("nope"), ValueError, "SIGNALS lists them"),
        (lambda leg: leg.record(["nope"]), ValueError, "SIGNALS lists them"),
        (lambda leg: leg.record(["tilt_deg"], every_ticks=0), ValueError, "every_ticks = 0"),
        (lambda leg: leg.recording(), LegError, "call record() first"),
        (lambda leg: SimulatedLeg(3), TypeError, "rig is no name"),
        (lambda leg: SimulatedLeg(tilt_deg=61), ValueError, "tilt_deg = 61 is not from 0 to 60"),
        (lambda leg: SimulatedLeg(payload_kg=NAN), ValueError, "payload_kg = NaN"),
        (lambda leg: SimulatedLeg(payload_kg=50, tilt_deg=30), LegError, "the leg cannot start"),
        (lambda leg: SimulatedLeg(slack=True, tilt_deg=3), ValueError, "slack is given"),
        (lambda leg: SimulatedLeg(seed=-1), ValueError, "seed = -1 is not from 0 to 18446744073709551615"),
        (lambda leg: SimulatedLeg("nope"), RigError, "cannot read the rig file nope"),
        (lambda leg: run_scenario("nope"), ScenarioError, "cannot read the scenario nope"),
        (lambda leg: run_scenario("hold", rig="nope"), RigError, "cannot read the rig file nope"),
        (lambda leg: run_scenario(None), TypeError, "scenario is no name"),
    ],
)
def test_an_argument_is_refused_by_its_name(call, error, words):
    leg = SimulatedLeg("table1")
    before = leg.ticks
    with pytest.raises(error) as refusal:
        call(leg)
    assert words in str(refusal.value)
    assert leg.ticks == before


def test_a_rig_file_is_refused_at_its_place(tmp_path):
    lines = (Path(__file__).parents[2] / "rigs" / "table1.toml").read_text().splitlines()
    line = next(number for number, text in enumerate(lines, 1) if text.startswith("leg_mm"))
    lines[line - 1] = "leg_mm = -3"
    file = tmp_path / "rig.toml"
    file.write_text("\n".join(lines))
    with pytest.raises(RigError) as refusal:
        SimulatedLeg(file)
    assert (refusal.value.file, refusal.value.line) == (str(file), line)
    assert refusal.value.column >= 1 and refusal.value.reason and refusal.value.remedy


def test_whatever_is_given_the_interpreter_goes_on():
    """Random calls with random arguments: nothing but the exceptions above comes, no panic of Rust among them."""
    dice = random.Random(1)
    values = [0, 1, -1, 2, 3, 30.0, 1e9, -1e300, 5e-324, NAN, INFINITY, None, "x", [], [[0, 0, 0], [1, 5, 5]], True, b""]
    values += list(DEFECTS)[:5] + ["supply_sag", "estimated", np.zeros((3, 3)), np.ones(3, bool), object(), 10**40]
    names = [name for name in dir(SimulatedLeg) if not name.startswith("_") and callable(getattr(SimulatedLeg, name))]
    assert len(names) > 20
    leg, done = SimulatedLeg("table1"), 0
    for _ in range(4000):
        name = dice.choice(names)
        given = [dice.choice(values) for _ in range(dice.randint(0, 3))]
        if name in ("run", "wait", "step"):
            given = [value for value in given if not isinstance(value, int | float) or abs(value) <= 3]
        try:
            getattr(leg, name)(*given)
            done += 1
        except (LegError, ValueError, TypeError):
            pass
        if dice.random() < 0.02:
            leg = SimulatedLeg("table1", slack=dice.random() < 0.5)
    assert done > 200
