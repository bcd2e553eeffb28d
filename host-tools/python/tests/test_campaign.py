"""Many scenarios at once: the same rows wherever they run, going on after a kill, and what repeats a failure."""

import json
import shlex
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from tendon_leg import READY_SCENARIOS, Rig, campaign, run_scenario

LEAN = """
title = "A leg leans"
steps = [
    {{ await = {{ state = "disarmed", timeout_s = 1 }} }},
    "arm",
    {{ move = {{ azimuth_deg = {azimuth_deg}, tilt_deg = 20 }} }},
    {{ arrive = {{ then_s = 0.3, timeout_s = 3 }} }},
    {{ measure = {{ name = "error", quantity = "tip_error_mm", between = [0, {bound_mm}] }} }},
]
seed = 5
[start.held]
azimuth_deg = 0
tilt_deg = 0
pretension_n = 70
payload_kg = 0
"""


def lean(azimuth_deg, bound_mm=0.05):
    return LEAN.format(azimuth_deg=azimuth_deg, bound_mm=bound_mm)


def heavier():
    values = Rig("table1").to_dict()
    values["mass"]["leg_kg"] = 2.0
    return Rig.from_dict(values, name="heavier")


def cases():
    rigs = {"paper": None, "universal": "universal", "heavier": heavier()}
    return [
        {"scenario": lean(azimuth_deg), "rig": rig, "seed": seed, "design": design, "azimuth_deg": azimuth_deg}
        for design, rig in rigs.items()
        for azimuth_deg in (0, 130)
        for seed in (1, 2)
    ]


def test_rows_are_those_of_single_runs_in_the_order_of_the_cases(tmp_path):
    listed = cases()
    seen = []
    rows = campaign(listed, tmp_path, progress=seen.append)
    assert len(seen) == len(rows) == 12
    for case, row in zip(listed, rows, strict=True):
        single = run_scenario(case["scenario"], rig=case["rig"], seed=case["seed"])
        assert row["passed"] and row["error"] is None
        assert (row["bits"], row["design"], row["seed"]) == (single["bits"], case["design"], case["seed"])
        assert row["error"] is None and row["title"] == "A leg leans"
        rigs = {"paper": "table1", "universal": "universal", "heavier": "heavier"}
        assert (row["scenario"], row["rig"]) == ("A leg leans", rigs[case["design"]])
    named = [{"scenario": "hold"}, {"scenario": "hold", "rig": Rig("table1")}, {"scenario": "no\nTOML"}]
    others = campaign(named, tmp_path)
    assert [row["scenario"] for row in others] == ["hold", "hold", ""]
    assert [row["rig"] for row in others] == ["table1"] * 3
    assert len({row["bits"] for row in rows}) == 12


def test_commands_that_the_leg_refused_are_told(tmp_path):
    text = 'title = "Armed by nobody"\nsteps = [{ await = { state = "disarmed", timeout_s = 1 } }, "keep_station"]\n'
    single = run_scenario(text)
    (told,) = single["refused"]
    assert told.startswith("keep_station (") and ": " in told
    (row,) = campaign([{"scenario": text}], tmp_path)
    assert row["refused"] == [told]
    (without,) = campaign([{"scenario": "hold"}], tmp_path)
    assert not without["refused"] and run_scenario("hold")["refused"] == []


def test_a_failure_keeps_what_repeats_it(tmp_path):
    strict = {"scenario": lean(40, bound_mm=1e-9), "rig": heavier(), "seed": 11}
    broken = {"scenario": "title = 3\n"}
    ready = {"scenario": "fault_cell_dead", "rig": "universal"}
    failed, refused, passed = campaign([strict, broken, ready], tmp_path / "of a name with spaces")
    assert not failed["passed"] and not refused["passed"] and passed["passed"]
    assert "line 1, column 9" in refused["error"] and "repeat" not in passed
    words = shlex.split(failed["repeat"])
    assert words[:4] == ["leg", "run", "--on", "sim"]
    again = run_scenario(Path(words[5]), rig=Path(words[7]))
    assert (again["bits"], again["passed"]) == (failed["bits"], False)


def test_only_what_is_missing_is_run_again(tmp_path):
    listed = cases()
    first = campaign(listed[:5], tmp_path)
    results = tmp_path / "results.jsonl"
    # Killed in the midst of a line.
    lines = results.read_text().splitlines(keepends=True)
    results.write_text("".join(lines[:4]) + lines[4][:20])
    fresh = []
    second = campaign(listed[:5], tmp_path, executor=Counting(fresh))
    assert second == first and len(fresh) == 1
    # Equal cases are run once.
    assert len(campaign([listed[7]] * 3, tmp_path, executor=Counting(fresh))) == 3
    assert len(fresh) == 2
    assert len(results.read_text().splitlines()) == 6


class Counting:
    """An executor that runs at once, and knows what."""

    def __init__(self, ran):
        self.ran = ran

    def submit(self, call, run):
        from concurrent.futures import Future

        self.ran.append(run)
        future = Future()
        future.set_result(call(run))
        return future


#: Cases that take a second each, so that a campaign is killed in the midst of them.
TOURS = [{"scenario": "tour", "seed": seed} for seed in range(5)]

PROGRAM = f"""
import sys
from tendon_leg import campaign
cases = {TOURS}
campaign(cases, sys.argv[1], progress=lambda row: print(row["seed"], flush=True))
"""

ON_CLUSTER = f"""
import sys
from distributed import Client
from tendon_leg import campaign
cases = {TOURS}
with Client(sys.argv[1]) as client, client.get_executor() as executor:
    campaign(cases, sys.argv[2], executor=executor, progress=lambda row: print(row["seed"], flush=True))
"""


def killed_after_a_row(program, *arguments, directory):
    """How many results a campaign has kept whose program was killed once it had told of one."""
    command = [sys.executable, "-c", program, *arguments, directory]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        child.stdout.readline()
        child.kill()
    done = len([line for line in (directory / "results.jsonl").read_text().splitlines() if line.endswith("}}")])
    assert 1 <= done < len(TOURS)
    return done


def test_a_killed_campaign_goes_on_where_it_was(tmp_path):
    done, fresh = killed_after_a_row(PROGRAM, directory=tmp_path), []
    rows = campaign(TOURS, tmp_path, executor=Counting(fresh))
    assert len(fresh) == len(TOURS) - done and all(row["passed"] for row in rows)


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster


def test_a_dask_cluster_gives_the_same_rows(cluster, tmp_path):
    listed = cases()[:4]
    with cluster.get_client() as client, client.get_executor() as executor:
        on_cluster = campaign(listed, tmp_path / "cluster", executor=executor)
    assert on_cluster == campaign(listed, tmp_path / "here")


def test_a_killed_campaign_on_a_dask_cluster_goes_on_where_it_was(cluster, tmp_path):
    done = killed_after_a_row(ON_CLUSTER, cluster.scheduler_address, directory=tmp_path)
    with cluster.get_client() as client, client.get_executor() as executor:
        ran = []
        submit = executor.submit
        executor.submit = lambda call, run: ran.append(run) or submit(call, run)
        rows = campaign(TOURS, tmp_path, executor=executor)
    assert len(ran) == len(TOURS) - done
    assert [(row["seed"], row["passed"]) for row in rows] == [(case["seed"], True) for case in TOURS]


def test_a_seed_of_numpy_is_the_same_seed(tmp_path):
    fresh = []
    for seed in (np.uint64(3), 3):
        [row] = campaign([{"scenario": lean(10), "seed": seed}], tmp_path, executor=Counting(fresh))
        assert row["passed"] and row["seed"] == 3
    assert len(fresh) == 1


@pytest.mark.parametrize(
    ("case", "words"),
    [
        ({}, "cases[1]: it has no `scenario`"),
        ({"scenario": 3}, "cases[1]: scenario: 3"),
        ({"scenario": "no such file"}, "no such file"),
        ({"scenario": "tour", "passed": True}, "cases[1]: its key 'passed'"),
        ({"scenario": "tour", "seed": -1}, "cases[1]: its seed -1"),
        ({"scenario": "tour", "seed": 1.5}, "cases[1]: its seed 1.5"),
        ({"scenario": "tour", "rig": "no such rig"}, "no such rig"),
        ({"scenario": "tour", "rig": 7}, "cases[1]: rig"),
    ],
)
def test_a_case_that_is_none_is_refused_before_anything_runs(tmp_path, case, words):
    began = time.monotonic()
    with pytest.raises(ValueError, match=r"cases\[1\]") as refusal:
        campaign([{"scenario": "tour"}, case], tmp_path)
    assert words in str(refusal.value) and time.monotonic() - began < 1.0
    assert not (tmp_path / "results.jsonl").exists()


def test_a_directory_that_is_none_is_refused_by_name(tmp_path):
    file = tmp_path / "file"
    file.write_text("x")
    for directory in (file, file / "below", "a\0b"):
        with pytest.raises(ValueError, match=r"directory = '.*' cannot be made: "):
            campaign([{"scenario": "tour"}], directory)
    (tmp_path / "results.jsonl").write_text("[]\n")
    with pytest.raises(ValueError, match=r"directory: line 1 of .*results.jsonl is no result of a campaign"):
        campaign([{"scenario": "tour"}], tmp_path)


def test_results_of_another_build_are_not_taken(tmp_path, monkeypatch):
    listed, fresh = cases()[:2], []
    campaign(listed, tmp_path, executor=Counting(fresh))
    monkeypatch.setattr(sys.modules["tendon_leg.campaign"], "_build", lambda: "another")
    campaign(listed, tmp_path, executor=Counting(fresh))
    assert len(fresh) == 4


def test_every_ready_scenario_has_its_text():
    assert all("title" in text for text in READY_SCENARIOS.values())
    assert json.dumps(READY_SCENARIOS)
