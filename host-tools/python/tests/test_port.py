"""A leg on a port, by `leg emulate`."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
from tendon_leg import Leg, LegError, LegFault, Refused, Rig
from test_leg import circle

ROOT = Path(__file__).parents[3]
needs_leg = pytest.mark.skipif("LEG" not in os.environ, reason="the variable LEG names no built `leg`; CI's does")


@contextmanager
def emulator(*arguments, command_time_s=30):
    """The port of a leg that is emulated in real time. A busy machine may stop its host for longer than the 0.2 s of the default."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as rig:
        rig.write((ROOT / "host-tools/rigs/table1.toml").read_text() + f"\n[control.limits]\ncommand_time_s = {command_time_s}\n")
        rig.flush()
        command = [ROOT / os.environ["LEG"], "emulate", "--json", "--rig", rig.name, *arguments]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stdin=subprocess.PIPE, text=True) as process:
            try:
                yield json.loads(process.stdout.readline())["port"]
            finally:
                process.terminate()


@pytest.fixture
def command_time_s():
    return 30


@pytest.fixture
def port(command_time_s):
    with emulator(command_time_s=command_time_s) as name:
        yield name


@needs_leg
@pytest.mark.parametrize("arguments", [["--tcp"], ["--on", "qemu"], ["--on", "chip", "--slack"]])
def test_a_leg_is_reached_wherever_its_firmware_runs(arguments):
    with emulator(*arguments, command_time_s=0.2) as name, Leg.open(name) as leg:
        before_s = time.time()
        told = leg.telemetry()
        assert told["state"] == "disarmed" and before_s <= told["wall_time_s"] <= time.time()
        assert leg.settings_differences("table1") == []
        assert 23 < leg.sensors()["supply_v"] < 25


@needs_leg
def test_the_boards_image_does_what_any_leg_does():
    # Most of it is homing, which takes the emulated chip more than half a minute.
    with emulator("--on", "chip", "--slack") as name, Leg.open(name) as leg, Leg.open(name) as watcher:
        values = leg.settings().to_dict()
        values["mass"]["leg_kg"] = 1.25
        heavier = Rig.from_dict(values)
        leg.set_settings(heavier, save=True)
        assert leg.settings_differences(heavier) == []
        with pytest.raises(Refused) as refusal:
            leg.move(30, 5)
        assert refusal.value.name == "Command.NotHomed"
        assert leg.home()["homed"]
        assert leg.move(30, 5)["tilt_deg"] == pytest.approx(5.0, abs=0.05)
        assert leg.stiffness(95)["stiffness_nm_per_rad"] == pytest.approx(95, rel=0.01)
        assert leg.follow([[0.0, 30.0, 5.0], [0.5, 30.0, 5.5], [1.0, 30.0, 5.5]], lead_s=2)["tilt_deg"] == pytest.approx(5.5, abs=0.05)
        ended = []

        def follow():
            with pytest.raises(LegError) as stopped:
                leg.follow([[t, 30.0, 5.5 + 0.5 * t] for t in range(31)], lead_s=2)
            ended.append(stopped)

        thread = threading.Thread(target=follow)
        thread.start()
        wait_for(watcher, lambda told: told["tilt_deg"] > 5.7)
        leg.stop()
        assert watcher.telemetry()["state"] == "held"
        thread.join()
        assert len(ended) == 1
        assert leg.scope()["tensions_n"].shape == (1600, 3)


DRIVEN = """
import sys, numpy as np
from tendon_leg import Leg
time_s = np.arange(0, 60, 0.01)
leg = Leg.open(sys.argv[1])
print("opened", flush=True)
leg.follow(np.column_stack([time_s, 72 * time_s, np.full_like(time_s, 20.0)]), lead_s=2)
"""


def wait_for(leg, condition):
    """Telemetry once a condition holds; in time for any machine."""
    deadline_s = time.monotonic() + 60.0
    while not condition(telemetry := leg.telemetry()):
        assert time.monotonic() < deadline_s, telemetry
        time.sleep(0.05)
    return telemetry


@needs_leg
def test_a_second_owner_is_refused_by_name_and_may_stop_the_leg(port):
    with Leg.open(port) as first, Leg.open(port) as second:
        ended = []

        def follow():
            with pytest.raises(LegError, match="another host stopped it") as stopped:
                first.follow(circle(60.0), lead_s=2)
            ended.append(stopped)

        thread = threading.Thread(target=follow)
        thread.start()
        wait_for(second, lambda told: told["tilt_deg"] > 15)
        for command in [lambda: second.move(0, 3), lambda: second.stiffness(100), lambda: second.follow(circle(1.0))]:
            with pytest.raises(Refused, match="another host drives the leg") as refusal:
                command()
            assert (refusal.value.code, refusal.value.name) == ((5,), "OtherHost")
        with pytest.raises(LegError, match="disarm"):
            second.set_settings("table1")
        assert second.telemetry()["state"] == "active"
        second.stop()
        assert second.telemetry()["state"] == "held"
        thread.join()
        assert len(ended) == 1


@needs_leg
def test_ctrl_c_in_mid_move_leaves_a_leg_on_a_port_in_hold_at_once(port):
    with subprocess.Popen([sys.executable, "-c", DRIVEN, port], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as driver:
        assert driver.stdout.readline() == "opened\n"
        with Leg.open(port) as watcher:
            assert wait_for(watcher, lambda told: told["tilt_deg"] > 15)["state"] == "active"
            driver.send_signal(signal.SIGINT)
            assert "KeyboardInterrupt" in driver.communicate(timeout=60)[1]
            # Not by its own timeout, which is a fault.
            told = watcher.telemetry()
            assert told["state"] == "held" and told["faults"] == [], told
    assert driver.returncode == -signal.SIGINT


@needs_leg
@pytest.mark.parametrize("command_time_s", [2])
def test_an_interpreter_that_is_killed_in_mid_move_leaves_the_leg_in_hold(port):
    with subprocess.Popen([sys.executable, "-c", DRIVEN, port], stdout=subprocess.PIPE, text=True) as driver:
        assert driver.stdout.readline() == "opened\n"
        with Leg.open(port) as watcher:
            assert wait_for(watcher, lambda told: told["tilt_deg"] > 15)["state"] == "active"
        driver.kill()
    with Leg.open(port) as watcher:
        told = wait_for(watcher, lambda told: told["state"] != "active")
        assert told["state"] == "held" and [fault["name"] for fault in told["faults"]] == ["no command"]
        with pytest.raises(LegFault, match=r"fault 20, no command: .*; then clear\(\); the leg is held"):
            watcher.move(0, 0)
        watcher.clear()
        assert watcher.move(0, 0)["tilt_deg"] < 0.1
