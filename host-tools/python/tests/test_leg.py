"""A leg that is commanded: emulated in this process, and on a port by `leg emulate`."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from tendon_leg import Leg, LegError, LegFault, Refused

ROOT = Path(__file__).parents[3]
needs_leg = pytest.mark.skipif("LEG" not in os.environ, reason="the variable LEG names no built `leg`; CI's does")


def circle(seconds):
    time_s = np.arange(0.0, seconds + 0.005, 0.01)
    return np.column_stack([time_s, 72.0 * time_s, np.full_like(time_s, 20.0)])


def test_a_leg_is_homed_moved_stiffened_held_and_disarmed():
    with Leg.emulated(slack=True) as leg:
        assert leg.telemetry()["state"] == "disarmed"
        with pytest.raises(Refused, match="the leg does not know its zero"):
            leg.move(30, 20)
        assert leg.home()["homed"]
        reached = leg.move(30, 20, stiffness_nm_per_rad=110)
        assert reached["tilt_deg"] == pytest.approx(20.0, abs=0.05)
        assert reached["azimuth_deg"] == pytest.approx(30.0, abs=0.1)
        assert leg.telemetry()["state"] == "keeping station"
        assert leg.stiffness(100)["stiffness_nm_per_rad"] == pytest.approx(100, rel=0.01)
        assert leg.follow(circle(3.0))["tilt_deg"] == pytest.approx(20.0, abs=0.1)
        leg.hold()
        leg.disarm()
        assert leg.telemetry()["state"] == "disarmed"


def test_refusals_and_faults_have_their_words():
    leg = Leg.emulated()
    with pytest.raises(Refused) as refusal:
        leg.move(0, 80)
    assert "cannot lean that far" in refusal.value.reason and refusal.value.remedy
    with pytest.raises(Refused, match="the path"):
        leg.follow(circle(3.0) * [0.05, 1, 1])
    with pytest.raises(LegFault) as fault:
        leg.stiffness(1e4)
    assert (fault.value.code, fault.value.name) == (14, "stiffness out of reach")
    leg.stop()
    assert leg.telemetry()["state"] == "held"


def test_a_closed_leg_is_refused_by_name():
    leg = Leg.emulated()
    leg.close()
    leg.close()
    with pytest.raises(LegError, match="this leg is closed"):
        leg.telemetry()


def test_a_stop_from_another_thread_ends_what_the_leg_does():
    leg, ended = Leg.emulated(), []

    def follow():
        try:
            leg.follow(circle(1000.0))
        except LegError as error:
            ended.append(str(error))

    thread = threading.Thread(target=follow)
    thread.start()
    while thread.is_alive():
        time.sleep(0.1)
        leg.stop()
    assert ended == ["another thread stopped the leg; it is in hold if it was driven"]
    assert leg.telemetry()["state"] == "held"


def test_ctrl_c_leaves_the_leg_in_hold():
    leg = Leg.emulated()
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        leg.follow(circle(1000.0))
    assert leg.telemetry()["state"] == "held"


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda leg: leg.move(np.nan, 3), ValueError, "azimuth_deg = NaN"),
        (lambda leg: leg.move(0, 91), ValueError, "tilt_deg = 91 is not from -90 to 90"),
        (lambda leg: leg.move(0, 1, pretension_n=9, stiffness_nm_per_rad=9), ValueError, "give one of them"),
        (lambda leg: leg.move(0, 1, towards_deg=9), ValueError, "towards_deg is given without"),
        (lambda leg: leg.stiffness(-1), ValueError, "nm_per_rad = -1"),
        (lambda leg: leg.follow(circle(1.0), lead_s=np.inf), ValueError, "lead_s = inf"),
        (lambda leg: leg.follow([[0, 0]]), ValueError, "points has the shape [1, 2]"),
        (lambda leg: Leg.open("/dev/nope"), LegError, "/dev/nope"),
        (lambda leg: Leg.emulated(3), TypeError, "rig is no name"),
    ],
)
def test_an_argument_is_refused_by_its_name(call, error, words):
    with pytest.raises(error) as refusal:
        call(Leg.emulated())
    assert words in str(refusal.value)


@pytest.fixture
def port():
    """The port of a leg that is emulated in real time."""
    command = [ROOT / os.environ["LEG"], "emulate", "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stdin=subprocess.PIPE, text=True) as emulator:
        yield json.loads(emulator.stdout.readline())["port"]
        emulator.terminate()


KILLED = """
import sys, numpy as np
from tendon_leg import Leg
time_s = np.arange(0, 60, 0.01)
leg = Leg.open(sys.argv[1])
print("opened", flush=True)
leg.follow(np.column_stack([time_s, 72 * time_s, np.full_like(time_s, 20.0)]))
"""


def wait_for(leg, condition):
    """Telemetry once a condition holds; in time for any machine."""
    deadline_s = time.monotonic() + 60.0
    while not condition(telemetry := leg.telemetry()):
        assert time.monotonic() < deadline_s, telemetry
        time.sleep(0.05)
    return telemetry


@needs_leg
def test_an_interpreter_that_is_killed_in_mid_move_leaves_the_leg_in_hold(port):
    with subprocess.Popen([sys.executable, "-c", KILLED, port], stdout=subprocess.PIPE, text=True) as driver:
        assert driver.stdout.readline() == "opened\n"
        with Leg.open(port) as watcher:
            assert wait_for(watcher, lambda told: told["tilt_deg"] > 15)["state"] == "active"
        driver.kill()
    with Leg.open(port) as watcher:
        told = wait_for(watcher, lambda told: told["state"] != "active")
        assert told["state"] == "held" and [fault["name"] for fault in told["faults"]] == ["no command"]
        watcher.clear()
        assert watcher.move(0, 0)["tilt_deg"] < 0.1
