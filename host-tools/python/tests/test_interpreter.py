"""The interpreter's end, copies of its process, and what else may come between: nothing panics, and no leg is left moving."""

import multiprocessing
import os
import pickle
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from tendon_leg import Leg, LegError, LegFault, LegTimeout, NoResult, Refused, Rig, RigError, SimulatedLeg
from test_port import emulator, needs_leg, wait_for

ENDS = """
import sys, threading, time
from tendon_leg import Leg, Rig, SimulatedLeg, run_scenario
leg = Leg.open(sys.argv[1]) if len(sys.argv) > 1 else Leg.emulated(slack=True)
simulated = SimulatedLeg()
path = [[0.1 * i, 0.0, 0.1 * i] for i in range(300)]
begun = threading.Event()

def endless():
    begun.set()
    while True:
        {call}

threading.Thread(target=endless, daemon=True).start()
begun.wait()
time.sleep(0.05)
"""

CALLS = [
    "leg.home()",
    "leg.wait(3600)",
    "leg.telemetry()",
    "simulated.run(3600)",
    "simulated.step()",
    "run_scenario('workspace')",
    "Rig().workspace_map(azimuths=1000, tilts=100)",
    "Rig().evaluate(0.0, 10.0)",
]


def ended(call, *arguments):
    """What a program says that ends while a thread of it is in a call."""
    program = ENDS.format(call=call)
    done = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    for word in ("panicked", "fatal", "Fatal", "abort"):
        assert word not in done.stderr, done.stderr


@pytest.mark.parametrize("call", CALLS)
def test_an_interpreter_ends_while_a_thread_is_in_a_call(call):
    for _ in range(4):
        ended(call)


@needs_leg
@pytest.mark.parametrize("call", ["leg.home()", "leg.follow(path)"])
def test_a_leg_is_held_where_an_interpreter_ends_in_mid_move(call):
    with emulator(*(["--slack"] if "home" in call else [])) as port:
        ended(call, port)
        with Leg.open(port) as leg:
            # At once: not by its own timeout, which is a fault.
            told = leg.telemetry()
            assert told["state"] in ("held", "disarmed") and told["faults"] == [], told


def test_a_thread_of_its_own_ends_with_the_interpreter():
    program = "from tendon_leg import Leg; leg = Leg.emulated(); leg.move(0, 5)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def in_a_copy(work):
    """What comes of some work in a copy of this process; a copy that hangs is ended."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe()
    process = context.Process(target=lambda: there.send(work()))
    process.start()
    try:
        assert here.poll(60), "the copy hangs"
        return here.recv()
    finally:
        process.kill()
        process.join()


def said(call):
    with pytest.raises(LegError) as refusal:
        call()
    return str(refusal.value)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a system without fork")
def test_a_copy_of_the_process_computes_and_leaves_the_leg_alone():
    rig, leg, simulated = Rig(), Leg.emulated(), SimulatedLeg()
    leg.move(0, 5)
    tilts_deg = np.linspace(0, 20, 5000)
    here = rig.evaluate(0.0, tilts_deg)["deviation_m"]
    simulated.arm()

    def there():
        words = said(leg.telemetry), said(leg.stop)
        leg.close()
        copied = simulated.clone()
        copied.move(0, 5)
        return words, rig.evaluate(0.0, tilts_deg)["deviation_m"], rig.workspace_map(azimuths=8, tilts=4), copied.ticks

    words, deviations_m, _, ticks = in_a_copy(there)
    assert words == ("this leg was opened in another process; open it in this one",) * 2
    assert np.array_equal(deviations_m, here)
    simulated.move(0, 5)
    assert ticks == simulated.ticks
    assert leg.telemetry()["state"] == "keeping station"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a system without fork")
def test_a_copy_is_not_waited_for_by_what_threads_did_before():
    simulated = SimulatedLeg()
    thread = threading.Thread(target=simulated.run, args=(20.0,))
    thread.start()
    time.sleep(0.05)
    pid = os.fork()
    if pid == 0:
        # An end as any program has it, with all that was registered.
        import atexit

        atexit._run_exitfuncs()
        os._exit(7)
    began = time.monotonic()
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 7
    assert time.monotonic() - began < 4.0
    thread.join()


def test_a_rig_is_compared_and_pickled():
    rig = Rig("universal")
    again = pickle.loads(pickle.dumps(rig))
    assert again == rig and hash(again) == hash(rig) and again.name == rig.name and again.text == rig.text
    assert rig != Rig("table1") and rig != "universal" and len({rig, again, Rig("table1")}) == 2
    values = rig.to_dict()
    # The words of a file do not matter.
    assert Rig.from_dict(values, name="another") == rig
    values["mass"]["leg_kg"] += 1e-9
    assert Rig.from_dict(values) != rig


@pytest.mark.parametrize(
    "error",
    [
        Refused((6, 3), "Command.OutOfReach", "too far", "less"),
        LegFault(23, "emergency stop", "it is pressed", "release it", "off"),
        RigError("wrong", "give another", "mine.toml", 3, 7),
        LegTimeout("too late"),
        NoResult("it would buckle"),
    ],
)
def test_an_error_comes_whole_out_of_another_process(error):
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


def test_a_leg_may_be_closed_in_a_callback():
    leg = Leg.emulated(slack=True)
    with pytest.raises(LegError, match="this leg is closed"):
        leg.calibrate_motors(lambda motor: leg.close())


def test_two_threads_on_one_leg_are_refused_or_served():
    leg, simulated = Leg.emulated(), SimulatedLeg()
    simulated.arm()
    odd = []

    def use():
        for azimuth_deg in range(0, 360, 60):
            for each in (leg, simulated):
                try:
                    each.move(azimuth_deg, 3)
                    each.telemetry()
                except LegError as error:
                    if "another thread uses this leg" not in str(error):
                        odd.append(error)

    threads = [threading.Thread(target=use) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert odd == []
    assert leg.move(0, 1)["tilt_deg"] == pytest.approx(1.0, abs=0.1)


ARRAYS = {
    "strided": lambda points: np.repeat(points, 2, axis=0)[::2],
    "columns first": np.asfortranarray,
    "single precision": lambda points: points.astype("float32"),
    "other byte order": lambda points: points.astype(">f8"),
    "objects": lambda points: points.astype(object),
    "lists": lambda points: points.tolist(),
}


@pytest.mark.parametrize("kind", ARRAYS)
def test_arrays_of_any_layout_mean_the_same(kind):
    points = np.column_stack([np.arange(11) / 8, np.zeros(11), np.full(11, 5.0)])
    points.flags.writeable = False
    legs = [SimulatedLeg(tilt_deg=5.0) for _ in range(2)]
    for leg, given in zip(legs, [points, ARRAYS[kind](points)], strict=True):
        leg.arm()
        leg.follow(given)
    assert legs[0].ticks == legs[1].ticks
    assert np.array_equal(legs[0].read("tensions_n"), legs[1].read("tensions_n"))
    rig = Rig()
    found = [rig.evaluate(array, 5.0)["deviation_m"] for array in (points, ARRAYS[kind](points))]
    assert np.array_equal(*found)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (np.ma.masked_array([1.0, 2.0], [False, True]), "masked"),
        (np.array([1 + 1j]), "complex128"),
        (np.array(["2026-01-01"], dtype="datetime64[D]"), "datetime64"),
        (np.array(["1.0"]), "<U3"),
        (np.zeros(2, dtype=[("x", float)]), "x"),
        (np.array([1, None], dtype=object), "holds NaN at index 1"),
        (np.array([object()]), "azimuth_deg"),
        (memoryview(b"12").cast("c"), "azimuth_deg"),
        (np.broadcast_to(0.0, (10**9,)), "more than 100000000"),
    ],
)
def test_arrays_that_are_none_of_numbers_are_refused(given, words):
    with pytest.raises((TypeError, ValueError), match="azimuth_deg") as refusal:
        Rig().evaluate(given, 5.0)
    assert words in str(refusal.value)


def test_another_interpreter_in_this_process_computes_and_ends():
    work = "import tendon_leg; print(round(tendon_leg.Rig().evaluate(0, 3)['deviation_m'], 6))"
    program = f"import _xxsubinterpreters as i; i.run_string(i.create(), {work!r})"
    for before in ("", "import tendon_leg\n"):
        command = [sys.executable, "-W", "ignore", "-c", before + program]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert (done.returncode, done.stdout) == (0, "0.000181\n"), done.stderr
