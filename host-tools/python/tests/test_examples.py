"""The examples that README.md does not run."""

import runpy
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"
sys.path.insert(0, str(EXAMPLES))


def run(name, directory, monkeypatch):
    """What an example has when it has drawn its picture."""
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(directory)
    values = runpy.run_path(str(EXAMPLES / f"{name}.py"))
    looked_at(values["figure"], plt.imread(directory / f"{name}.png"))
    return values


def looked_at(figure, picture):
    """Every chart says what it is and has something drawn in it, of more than a few colours."""
    charts = [axis for axis in figure.axes if axis.get_label() != "<colorbar>"]
    for axis in charts:
        assert axis.get_title() or axis is not charts[0]
        assert axis.name == "polar" or axis.get_ylabel(), axis
        lines = [np.asarray(line.get_ydata(), float) for line in axis.lines]
        assert lines or axis.collections, axis
        assert all(np.isfinite(line).any() for line in lines), axis
    height, width, _ = picture.shape
    assert len(np.unique(picture.reshape(height * width, -1), axis=0)) > 100


def test_a_payload_is_estimated(tmp_path, monkeypatch):
    seen = run("payload", tmp_path, monkeypatch)["seen"]
    for time_s in [1.4, 2.9, 4.4, 5.9]:
        row = np.searchsorted(seen["time_s"] - seen["time_s"][0], time_s)
        assert seen["payload_kg"][row] == pytest.approx(seen["payload_true_kg"][row], abs=0.05)
        assert seen["tip_error_mm"][row] < 0.1


def test_more_pretension_makes_the_leg_stiffer_everywhere(tmp_path, monkeypatch):
    softest = np.array(run("stiffness_map", tmp_path, monkeypatch)["softest"])
    assert np.all(np.diff(softest, axis=0) > 0)


def test_a_torn_wire_is_named_and_the_leg_held(tmp_path, monkeypatch):
    values = run("fault", tmp_path, monkeypatch)
    assert values["told"] == "fault 3, jump of a tension: the leg is held"
    assert np.ptp(values["seen"]["tilt_true_deg"][-200:]) < 0.5


def test_a_leg_of_an_own_rig_sags_more_and_moves_as_it_is_told(tmp_path, monkeypatch):
    values = run("own_rig", tmp_path, monkeypatch)
    assert np.all(values["sag_mm"]["mine"][1:] > values["sag_mm"]["rigs/table1.toml"][1:])
    assert values["leg"].truth()["tilt_true_deg"] == pytest.approx(25.0, abs=0.02)


def test_fig_9_is_drawn_in_twenty_lines(tmp_path, monkeypatch):
    assert len((EXAMPLES / "fig9.py").read_text().splitlines()) <= 20
    axis = run("fig9", tmp_path, monkeypatch)["axis"]
    ends_mm = {}
    for line in axis.lines:
        marks = line.get_marker(), float(line.get_xdata()[-1])
        ends_mm.setdefault(marks, []).append(float(line.get_ydata()[-1]))
    model, published = ends_mm["None", 30.0], ends_mm["x", 30.0]
    assert model == pytest.approx(published, rel=0.015)
    # The tendons of the simulated leg become stiffer under more tension: it sags less with more payload.
    simulated = ends_mm["o", 30.0]
    assert np.all(np.diff(simulated) > 1.0) and simulated[0] == pytest.approx(model[0], rel=0.05)
    assert 7.0 < simulated[-1] < 7.5


def test_the_gymnasium_environment_is_one():
    from gym_environment import LegReaching
    from gymnasium.utils.env_checker import check_env

    check_env(LegReaching(), skip_render_check=True)


def test_an_agent_that_asks_for_the_target_earns_more_than_one_that_does_not():
    from gym_environment import STEPS, LegReaching

    def earned(agent):
        environment = LegReaching()
        observation, _ = environment.reset(seed=1)
        total, ended = 0.0, False
        while not ended:
            observation, reward, stopped, over, _ = environment.step(agent(environment, observation))
            total, ended = total + reward, stopped or over
        assert environment.steps == STEPS
        return total

    def asks(environment, observation):
        target = observation[2:4]
        far = np.hypot(*target)
        return np.arcsin(far) / environment.edge_rad * target / max(far, 1e-9)

    assert earned(asks) > 0.6 * earned(lambda *_: np.zeros(2))
