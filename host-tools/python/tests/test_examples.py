"""The examples, and what their pictures show."""

import runpy
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgb

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


def pixels_of(line, picture):
    """Which points of a drawn line have its colour in the picture, within two pixels."""
    figure = line.figure
    height, width, _ = picture.shape
    places = line.axes.transData.transform(line.get_xydata()) * width / figure.bbox.width
    columns, rows = np.round(places).astype(int).T
    far = np.abs(picture[..., :3] - to_rgb(line.get_color())).max(axis=2)
    boxes = [far[height - 1 - row - 2 : height - 1 - row + 3, column - 2 : column + 3] for column, row in zip(columns, rows, strict=True)]
    return np.array([box.min() < 0.1 for box in boxes])


def test_the_tip_of_a_leg_with_an_unknown_payload_stays_on_its_circle(tmp_path, monkeypatch):
    values = run("circle", tmp_path, monkeypatch)
    seen, (path, error) = values["seen"], (values["path"], values["error"])
    assert seen["time_s"][[0, -1]] == pytest.approx(seen["time_s"][0] + np.array([0.0, 10.0]), abs=0.01)
    # The bound of the ready scenario `circle`, which is the same path with the same payload. A leg that sags has 3 mm.
    assert 0.005 < seen["path_error_mm"].max() < 0.05
    # The circle is drawn that was asked for: of 219 mm · sin 20°.
    radii_mm = np.hypot(*seen["tip_commanded_mm"][:, :2].T)
    tip_mm = np.linalg.norm(seen["tip_commanded_mm"][0])
    assert radii_mm == pytest.approx(np.full_like(radii_mm, tip_mm * np.sin(np.radians(20.0))), abs=0.01)
    # What the picture shows is the error, in µm and 500 times as large, and both curves are seen where their numbers are.
    (drawn_error,), (commanded, drawn_path) = error.lines, path.lines
    assert drawn_error.get_ydata() == pytest.approx(1000 * seen["path_error_mm"])
    off_mm = np.linalg.norm(drawn_path.get_xydata() - commanded.get_xydata(), axis=1) / 500
    assert 0.002 < off_mm.max() < 0.05
    picture = plt.imread(tmp_path / "circle.png")
    assert pixels_of(drawn_error, picture).all()
    # The commanded circle is dashed, and covered where the tip is on it: the nearer the tip keeps to it, the less of it is seen.
    assert pixels_of(drawn_path, picture).mean() > 0.9
    assert 0.02 < pixels_of(commanded, picture).mean()
    assert f"{1000 * seen['path_error_mm'].max():.0f} µm" in error.get_title()


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
    assert np.all(values["sag_mm"]["mine"][1:] > values["sag_mm"]["table1"][1:])
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
