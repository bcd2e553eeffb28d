"""Rigs, the model at poses, maps and curves."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from tendon_leg import OUTPUTS, READY_RIGS, NoResult, Rig, RigError, SimulatedLeg, run_scenario

ROOT = Path(__file__).parents[3]
GOLDEN = ROOT / "tests" / "golden"
NONLINEAR = "deviation_nonlinear_m"
ALL = list(OUTPUTS)
OF_MAP = ["tensions_n", "level_range_n", "feasible", "bending_stiffness_nm_per_rad", "deviation_m"]


def lines(name):
    return [json.loads(line) for line in (GOLDEN / name).read_text().splitlines()]


def poses(count, tilt_deg=30.0):
    """Poses all over the workspace, equal in every run."""
    number = np.arange(count)
    return 360.0 * ((number * 0.6180339887) % 1.0), tilt_deg * np.sqrt((number + 0.5) / count)


def test_the_golden_cases_of_an_independent_program_agree():
    for case, expected in zip(lines("cases.jsonl"), lines("expected.jsonl"), strict=True):
        found = Rig("table1").evaluate(**case, outputs=ALL)
        for key, value in expected.items():
            # As `leg eval`: 1e-6 of the largest number.
            scale = np.abs(np.asarray(value, float)).max()
            assert np.abs(np.asarray(found[key], float) - value).max() <= 1e-6 * scale, key


@pytest.mark.skipif("LEG" not in os.environ, reason="the variable LEG names no built `leg`; CI's does")
@pytest.mark.parametrize("name", READY_RIGS)
def test_leg_eval_answers_the_same_numbers(name):
    rig = Rig(name)
    azimuth_deg, tilt_deg = poses(25, rig.tilt_max_deg)
    cases = [
        {"azimuth_deg": azimuth, "tilt_deg": tilt, "payload_kg": 0.02 * number, "demand_nm_per_rad": 80.0 + number}
        for number, (azimuth, tilt) in enumerate(zip(azimuth_deg, tilt_deg, strict=True))
    ]
    command = [ROOT / os.environ["LEG"], "eval", "--rig", name]
    answered = subprocess.run(command, input="\n".join(map(json.dumps, cases)), capture_output=True, text=True)
    found = rig.evaluate(
        azimuth_deg, tilt_deg, 0.02 * np.arange(25), demand_nm_per_rad=80.0 + np.arange(25), outputs=ALL, raises=False
    )
    compared = 0
    for number, answer in enumerate(map(json.loads, answered.stdout.splitlines())):
        assert ("error" in answer) == (number in found["errors"])
        if "error" in answer:
            assert answer["error"] == found["errors"][number]
            continue
        commanded = answer.pop("commanded")
        answer["commanded_level_n"] = commanded["level_n"]
        answer["commanded_stiffness_nm_per_rad"] = commanded["stiffness_nm_per_rad"]
        answer.pop("level_limits")
        answer.setdefault(NONLINEAR, np.nan)
        assert set(answer) == set(ALL)
        for key, value in answer.items():
            assert np.array_equal(found[key][number], value, equal_nan=key == NONLINEAR), (key, number)
        compared += 1
    assert compared >= 20


@pytest.mark.parametrize("name", READY_RIGS)
def test_an_array_gives_what_its_poses_give(name):
    rig = Rig(name)
    azimuth_deg, tilt_deg = poses(1100, rig.tilt_max_deg)
    together = rig.evaluate(azimuth_deg, tilt_deg, 0.5, raises=False)
    assert together["errors"] == {}
    for number in range(0, 1100, 111):
        alone = rig.evaluate(azimuth_deg[number], tilt_deg[number], 0.5)
        for key in alone:
            assert np.array_equal(alone[key], together[key][number], equal_nan=key.startswith("commanded")), key
    # Few outputs take another way through the model.
    few = rig.evaluate(azimuth_deg, tilt_deg, 0.5, outputs=OF_MAP)
    assert list(few) == OF_MAP
    for key in OF_MAP:
        assert np.array_equal(few[key], together[key]), key


def test_arrays_go_together_by_numpys_rules():
    rig = Rig()
    azimuth_deg, tilt_deg = np.linspace(0, 300, 4), np.linspace(0, 20, 3)[:, None]
    found = rig.evaluate(azimuth_deg, tilt_deg, payload_kg=[1.0])
    assert found["deviation_m"].shape == (3, 4) and found["deviation_m"].dtype == np.float64
    assert found["tensions_n"].shape == (3, 4, 3) and found["stiffness_nm_per_rad"].shape == (3, 4, 3, 3)
    assert found["feasible"].dtype == np.bool_
    assert found["deviation_m"][2, 1] == rig.evaluate(100, 20, 1)["deviation_m"]
    assert rig.evaluate([], [])["tensions_n"].shape == (0, 3)
    one = rig.evaluate(30, 20)
    assert isinstance(one["deviation_m"], float) and isinstance(one["feasible"], bool)
    assert one["moment_map_m"].shape == (3, 3)


def test_a_demanded_stiffness_finds_its_pretension():
    rig = Rig()
    found = rig.evaluate(30.0, 10.0, 0.5, demand_nm_per_rad=[60.0, 90.0, 1e5])
    level_n, reached = found["commanded_level_n"], found["commanded_stiffness_nm_per_rad"]
    # The search of the pretension ends within a part of 1e-4.
    assert reached[:2] == pytest.approx([60.0, 90.0], rel=1e-4)
    again = rig.evaluate(30.0, 10.0, 0.5, level_n=level_n[:2], stiffness_at="tension")
    assert again["bending_stiffness_nm_per_rad"][:, 0] == pytest.approx(reached[:2])
    # The nearest that the bounds allow.
    assert level_n[2] == pytest.approx(found["level_range_n"][2, 1])
    assert rig.evaluate(0, 10, demand_nm_per_rad=80, demand_towards_deg=[0, 90])["commanded_level_n"].shape == (2,)


def test_the_nonlinear_deviation_is_below_the_linear_one():
    found = Rig().evaluate(30.0, [10.0, 30.0], 2.0, outputs=["deviation_m", NONLINEAR])
    assert (found[NONLINEAR] < found["deviation_m"]).all() and (found[NONLINEAR] > 0.8 * found["deviation_m"]).all()


def test_what_has_no_result_is_raised_or_listed():
    rig = Rig("spherical")
    with pytest.raises(ValueError, match="pose 1: `tilt_deg` is beyond the range .* give -60 to 60"):
        rig.evaluate(0, [10, 70])
    listed = rig.evaluate(0, [10, 70], outputs=["deviation_m", "feasible"], raises=False)
    assert list(listed["errors"]) == [1] and "give -60 to 60" in listed["errors"][1]
    assert np.isnan(listed["deviation_m"]).tolist() == [False, True] and listed["feasible"].tolist() == [True, False]
    with pytest.raises(NoResult, match="no result"):
        Rig("compliant_pivot").evaluate(0, 15, 50, level_n=1.0, stiffness_n_per_m=1.0)


def test_a_map_is_that_of_its_poses():
    rig = Rig("leaf_spring_universal")
    found = rig.workspace_map(0.5, azimuths=12, tilts=4, nonlinear=True)
    assert found["azimuth_deg"] == pytest.approx(np.arange(0, 360, 30))
    assert found["tilt_deg"] == pytest.approx(np.linspace(0, rig.tilt_max_deg, 4))
    poses = rig.evaluate(found["azimuth_deg"], found["tilt_deg"][:, None], 0.5, outputs=[*OF_MAP, NONLINEAR])
    np.testing.assert_allclose(found["deviation_mm"], 1000 * poses["deviation_m"], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(found["deviation_nonlinear_mm"], 1000 * poses[NONLINEAR], rtol=1e-9, atol=1e-9)
    softest = poses["bending_stiffness_nm_per_rad"][..., 0]
    np.testing.assert_allclose(found["stiffness_min_nm_per_rad"], softest, rtol=1e-12)
    assert (found["feasible"] == poses["feasible"]).all() and found["margin_n"].shape == (4, 12)


def test_a_tendons_curve_rises_to_its_end():
    rig = Rig()
    tensions_n = np.linspace(0, 150, 301)
    curve = rig.tendon_curve(tensions_n, tendon=2)
    slope = np.gradient(tensions_n, curve["elongation_m"])
    assert (np.diff(curve["elongation_m"]) > 0).all()
    np.testing.assert_allclose(curve["stiffness_n_per_m"][1:-1], slope[1:-1], rtol=0.05)
    assert np.isnan(rig.tendon_curve([1e6])["elongation_m"]).all()


def test_a_rig_is_edited_as_a_dictionary():
    values = Rig("table1").to_dict()
    values["mass"]["leg_kg"] = 2.0
    heavy = Rig.from_dict(values, name="heavy")
    load_nm = [rig.evaluate(0, 20)["load_moment_nm"][1] for rig in (Rig("table1"), heavy)]
    assert load_nm[1] / load_nm[0] == pytest.approx(2.0 / 1.5)
    assert Rig.parse(heavy.text).to_dict() == heavy.to_dict() == values
    # Numbers of numpy are numbers.
    values["mass"]["leg_kg"] = np.float32(2.0)
    values["tendon"]["f_max_n"] = np.int64(values["tendon"]["f_max_n"])
    assert Rig.from_dict(values) == heavy
    leg = SimulatedLeg(heavy)
    leg.arm()
    assert leg.state == "active"
    assert run_scenario("hold", rig=heavy)["bits"] != run_scenario("hold")["bits"]


@pytest.mark.parametrize(
    ("section", "key", "value", "words"),
    [
        ("mass", "leg_kg", -1, "`leg_kg` must not be negative"),
        ("mass", "leg_gk", 1, "unknown key `leg_gk`"),
        ("workspace", "tilt_deg", 80, "`tilt_deg` is beyond the range"),
        ("mass", "leg_kg", "x", "leg_kg"),
    ],
)
def test_a_rig_is_refused_at_its_place(section, key, value, words):
    values = Rig("table1").to_dict()
    values[section][key] = value
    with pytest.raises(RigError) as refusal:
        Rig.from_dict(values, name="mine")
    assert words in refusal.value.reason and refusal.value.file == "mine"
    assert refusal.value.line > 1 and refusal.value.column >= 1 and refusal.value.remedy


def of_itself():
    values = {}
    values["mass"] = values
    return values


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda rig: rig.evaluate([0, 1], [2, 3, 4]), ValueError, "tilt_deg has the shape [3]"),
        (lambda rig: rig.evaluate(0, np.nan), ValueError, "tilt_deg holds NaN at index 0"),
        (lambda rig: rig.evaluate("x", 0), TypeError, "azimuth_deg is no array of numbers"),
        (lambda rig: rig.evaluate(None, 0), ValueError, "azimuth_deg holds NaN"),
        (lambda rig: rig.evaluate(0, [[1], [2, 3]]), TypeError, "tilt_deg is no array of numbers"),
        (lambda rig: rig.evaluate(0, 10, -1), ValueError, "`payload_kg`"),
        (lambda rig: rig.evaluate(0, 10, leg_mass_kg=-1), ValueError, "`leg_mass_kg` must not be negative"),
        (lambda rig: rig.evaluate(0, 10, stiffness_n_per_m=np.inf), ValueError, "stiffness_n_per_m = inf"),
        (lambda rig: rig.evaluate(0, 10, f_min_n=200), ValueError, "`f_min_n`"),
        (lambda rig: rig.evaluate(0, 10, support="x"), ValueError, "there is no support `x`"),
        (lambda rig: rig.evaluate(0, 10, stiffness_at="x"), ValueError, "`stiffness_at` cannot be `x`"),
        (lambda rig: rig.evaluate(0, 10, outputs=["x"]), ValueError, "OUTPUTS lists them"),
        (lambda rig: rig.evaluate(0, 10, demand_towards_deg=3), ValueError, "without demand_nm_per_rad"),
        (lambda rig: rig.evaluate(np.zeros((10**5, 1)), np.zeros(10**5)), ValueError, "more than 100000000"),
        (lambda rig: rig.workspace_map(np.nan), ValueError, "payload_kg = NaN"),
        (lambda rig: rig.workspace_map(azimuths=2), ValueError, "azimuths = 2 is not from 3"),
        (lambda rig: rig.workspace_map(tilts=10**9), ValueError, "tilts = 1000000000 is not"),
        (lambda rig: rig.tendon_curve([1.0], tendon=0), ValueError, "tendon = 0 is none of"),
        (lambda rig: rig.tendon_curve("x"), TypeError, "tensions_n is no array"),
        (lambda rig: Rig(3), TypeError, "rig is no name"),
        (lambda rig: rig.tendon_curve([1.0, -1.0]), ValueError, "tensions_n holds -1 at index 1, which is below 0"),
        (lambda rig: Rig.from_dict({"mass": np.nan}), ValueError, "values['mass'] = NaN is not a finite number"),
        (lambda rig: Rig.from_dict({"mass": {"leg_kg": -np.inf}}), ValueError, "values['mass']['leg_kg'] = -inf is not"),
        (lambda rig: Rig.from_dict({"a": [{"b": 1}, {"b": np.nan}]}), ValueError, "values['a'][1]['b'] = NaN is not"),
        (lambda rig: Rig.from_dict({"mass": {"leg_kg": print}}), ValueError, "values['mass']['leg_kg'] cannot be JSON: it is <class"),
        (lambda rig: Rig.from_dict({"mass": {"leg_kg": np.float32("nan")}}), ValueError, "values['mass']['leg_kg'] = NaN is not"),
        (lambda rig: Rig.from_dict(of_itself()), ValueError, "Circular reference"),
        (lambda rig: Rig.from_dict({"mass": None}), RigError, "a rig file has no null"),
        (lambda rig: Rig.parse("[mass"), RigError, "not TOML"),
    ],
)
def test_an_argument_is_refused_by_its_name(call, error, words):
    with pytest.raises(error) as refusal:
        call(Rig("table1"))
    assert words in str(refusal.value)
