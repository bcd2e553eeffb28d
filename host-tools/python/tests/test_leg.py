"""A leg that is commanded: emulated in this process."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from tendon_leg import Leg, LegError, LegFault, Refused, Rig, RigError, SimulatedLeg


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
        told = leg.telemetry()
        assert told["state"] == "keeping station" and told["damaged_frames"] == 0
        # Its clock is emulated.
        assert np.isnan(told["wall_time_s"])
        assert leg.stiffness(100)["stiffness_nm_per_rad"] == pytest.approx(100, rel=0.01)
        assert leg.follow(circle(3.0))["tilt_deg"] == pytest.approx(20.0, abs=0.1)
        leg.hold()
        leg.disarm()
        assert leg.telemetry()["state"] == "disarmed"


@pytest.mark.parametrize("address", [1, 6])
def test_a_leg_on_a_bus_is_homed_moved_and_set(address):
    with Leg.emulated(slack=True, can=address) as leg:
        # Settings take many frames of the bus.
        leg.set_settings(leg.settings())
        assert leg.home()["homed"]
        assert leg.move(30, 20, stiffness_nm_per_rad=110)["tilt_deg"] == pytest.approx(20.0, abs=0.05)
        assert leg.follow(circle(3.0))["tilt_deg"] == pytest.approx(20.0, abs=0.1)
        leg.stop()
        told = leg.telemetry()
        assert told["state"] == "held" and told["damaged_frames"] == 0 and np.isnan(told["wall_time_s"])
        assert leg.scope()["tensions_n"].shape[1] == 3
        leg.disarm()


def test_a_path_that_is_too_fast_is_refused_for_its_speed():
    time_s = np.arange(0.0, 5.0, 0.01)
    turns = np.column_stack([time_s, 100 * 72.0 * time_s, np.full_like(time_s, 20.0)])
    for leg in (Leg.emulated(), SimulatedLeg()):
        if isinstance(leg, SimulatedLeg):
            leg.arm()
        with pytest.raises(Refused, match="speed_rad_per_s; take more time"):
            leg.follow(turns)


def test_a_path_changes_the_tensions_on_the_way():
    points = circle(3.0)
    with Leg.emulated() as leg:
        leg.follow(points, pretension_n=np.linspace(70.0, 85.0, len(points)))
        assert leg.telemetry()["pretension_n"] == pytest.approx(85.0, abs=0.1)
        leg.follow(points, stiffness_nm_per_rad=60.0)
        assert leg.telemetry()["stiffness_nm_per_rad"] == pytest.approx(60.0, abs=0.5)
        with pytest.raises(LegFault) as fault:
            leg.follow(points, stiffness_nm_per_rad=1e4)
        assert (fault.value.code, fault.value.name) == (14, "stiffness out of reach")
        assert leg.telemetry()["tilt_deg"] == pytest.approx(20.0, abs=0.1)


def test_refusals_and_faults_have_their_words():
    leg = Leg.emulated()
    with pytest.raises(Refused) as refusal:
        leg.move(0, 80)
    assert "cannot lean that far" in refusal.value.reason and refusal.value.remedy
    # As `firmware/PROTOCOL.md` lists them.
    assert (refusal.value.code, refusal.value.name) == ((6, 3), "Command.OutOfReach")
    with pytest.raises(Refused, match="the path") as refusal:
        leg.follow(circle(3.0) * [0.05, 1, 1])
    assert (refusal.value.code, refusal.value.name) == ((6, 6, 9, 0), "Command.Point.Limit.Speed")
    with pytest.raises(LegFault) as fault:
        leg.stiffness(1e4)
    assert (fault.value.code, fault.value.name) == (14, "stiffness out of reach")
    leg.stop()
    assert leg.telemetry()["state"] == "held"


def test_remedies_are_calls_and_not_commands_of_a_shell():
    leg = Leg.emulated(slack=True)
    with pytest.raises(Refused) as refusal:
        leg.move(30, 20)
    assert refusal.value.remedy == "home it: home()"
    leg = Leg.emulated()
    leg.move(30, 10)
    with pytest.raises(LegError, match=r"call disarm\(\) first"):
        leg.set_settings("table1")
    for call in (Leg.open, lambda: Rig("nope"), lambda: leg.calibrate_cell(1, [0, 5], lambda kg: None)):
        with pytest.raises(LegError) as error:
            call()
        assert "--" not in str(error.value) and "`leg" not in str(error.value), error.value


def test_settings_are_read_compared_and_replaced():
    leg = Leg.emulated()
    assert leg.settings_differences("table1") == []
    values = leg.settings().to_dict()
    values["mass"]["leg_kg"] = 2.0
    heavier = Rig.from_dict(values)
    [difference] = leg.settings_differences(heavier)
    assert "mass" in difference["name"] and difference["rig"] == 2.0 != difference["leg"]
    leg.set_settings(heavier, save=True)
    assert leg.settings_differences(heavier) == []
    with pytest.raises(Refused, match="the leg does not know its zero"):
        leg.move(10, 5)
    with pytest.raises(RigError, match="nope"):
        leg.set_settings("nope")


def test_settings_are_not_replaced_while_the_leg_is_armed():
    leg = Leg.emulated()
    leg.move(30, 10)
    with pytest.raises(LegError, match="disarm"):
        leg.set_settings("table1")
    with pytest.raises(LegError, match="weights be hung on its cells while its drivers are on"):
        leg.calibrate_cell(1, [0, 5], lambda kg: None)
    assert leg.settings_differences("table1") == []


def hang_on(leg, cell, error_kg=0.0):
    """Hangs weights on an emulated cell, one of them another than is said."""

    def hang(kg):
        newtons = 9.81 * (kg + error_kg * (kg == 2.0))
        leg.disturb({"hang": {"cell": cell, "newtons": newtons}})
        leg.wait(1.5)

    return hang


def test_a_load_cell_is_calibrated_by_weights():
    leg = Leg.emulated(slack=True)
    before = leg.settings()
    with pytest.raises(LegError, match="off a straight line"):
        leg.calibrate_cell(2, [0, 1, 2, 5], hang_on(leg, 2, error_kg=0.2), set=True)
    assert leg.settings_differences(before) == []
    found = leg.calibrate_cell(2, [0, 1, 2, 5], hang_on(leg, 2), set=True, save=True)
    assert found["residual_n"] < 0.05
    for difference in leg.settings_differences(before):
        assert "cell" in difference["name"]
    leg.disturb({"hang": {"cell": 2, "newtons": 30.0}})
    leg.wait(1.5)
    assert leg.sensors()["axes"][1]["tension_n"] == pytest.approx(30.0, abs=0.1)


def turn_by_hand(leg):
    def turn(motor):
        leg.disturb({"turn": {"motor": motor, "turns": 1}})
        leg.wait(1.5)

    return turn


def test_encoders_are_checked_by_turning_the_motors():
    leg = Leg.emulated(slack=True)
    found = leg.calibrate_motors(turn_by_hand(leg))
    assert [(row["motor"], row["passed"], row["verdict"]) for row in found] == [(1, True, "pass"), (2, True, "pass"), (3, True, "pass")]
    leg.disturb({"fault": {"encoder_reversed": 2}})
    leg.disturb({"fault": {"encoder_lost": 3}})
    found = leg.calibrate_motors(turn_by_hand(leg), "table1")
    assert [row["passed"] for row in found] == [True, False, False]
    assert found[1]["counts_sign"] == -1 and found[1]["counts"] == -found[0]["counts"]
    assert "set its counts_sign to -1" in found[1]["verdict"]
    assert found[2]["counts"] == 0 and "wiring" in found[2]["verdict"]
    with pytest.raises(ZeroDivisionError):
        leg.calibrate_motors(lambda motor: 1 / 0)


def test_one_motor_is_turned_slowly():
    leg = Leg.emulated(slack=True)
    seen = leg.jog(2, 1.0)
    assert seen["findings"] == []
    assert seen["pulled_m"] == pytest.approx([0.0, 1e-3, 0.0], abs=2e-4)
    leg.disturb({"fault": "encoders_swapped"})
    (finding,) = leg.jog(2, 1.0)["findings"]
    assert finding["what"] == "encoder 1 counted when motor 2 was driven"
    assert "interchange" in finding["remedy"]
    assert leg.telemetry()["state"] == "disarmed"


def test_an_emulated_leg_is_disturbed_and_no_other():
    leg = Leg.emulated()
    leg.move(30, 20)
    leg.disturb({"payload": {"kg": 1.0, "over_s": 0.2}})
    leg.wait(2.0)
    assert leg.telemetry()["payload_kg"] == pytest.approx(1.0, abs=0.05)
    before = leg.scope()
    assert "since_fault_s" not in before
    leg.wait(0.3)
    leg.disturb({"emergency_stop": True})
    leg.wait(0.1)
    kept = leg.scope()
    signals = {"time_s", "tick", "since_fault_s", "tensions_n", "pulled_m", "duties"}
    assert set(kept) == signals | {"fault_names"}
    assert kept["fault_names"] == ["emergency stop"]
    assert kept["tensions_n"].shape == (1600, 3)
    assert kept["since_fault_s"] == pytest.approx(np.arange(-1200, 400) / 8000)
    assert np.all(kept["duties"][1200:] == 0)
    assert leg.sensors()["emergency_stop"]
    assert leg.telemetry()["state"] == "off"


def test_a_closed_leg_is_refused_by_name():
    leg = Leg.emulated()
    leg.close()
    leg.close()
    with pytest.raises(LegError, match="this leg is closed"):
        leg.telemetry()


def test_a_stop_from_another_thread_ends_what_the_leg_does():
    leg, begun, ended = Leg.emulated(), threading.Event(), []

    def follow():
        points = circle(100.0)
        begun.set()
        try:
            leg.follow(points)
        except LegError as error:
            ended.append(str(error))

    thread = threading.Thread(target=follow)
    thread.start()
    begun.wait()
    time.sleep(0.5)
    leg.stop()
    # It returns once the leg is in hold, and belongs to nobody.
    assert leg.telemetry()["state"] == "held"
    thread.join()
    assert ended == ["another thread stopped the leg; it is in hold if it was driven"]


def test_a_stop_holds_the_leg_when_another_thread_only_waits():
    leg = Leg.emulated()
    for delay_s in np.linspace(0.0, 0.005, 10):
        leg.clear()
        leg.move(0, 5)
        thread = threading.Thread(target=lambda: pytest.raises(LegError, leg.wait, 86_400.0))
        thread.start()
        time.sleep(delay_s)
        # Until the thread has begun, a stop is over before.
        while thread.is_alive():
            leg.stop()
        assert leg.telemetry()["state"] == "held"


def test_ctrl_c_leaves_the_leg_in_hold():
    leg = Leg.emulated()
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        leg.follow(circle(100.0))
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
        (lambda leg: Leg.open("tcp://127.0.0.1:1"), LegError, "tcp://127.0.0.1:1"),
        (lambda leg: Leg.can("nope"), LegError, "nope"),
        (lambda leg: Leg.can("can0", 7), ValueError, "leg = 7 is none of 1 to 6"),
        (lambda leg: leg.disturb({"payload": {"kg": np.nan}}), ValueError, "action['payload']['kg'] = NaN is not"),
        (lambda leg: leg.disturb({"kick": 1}), ValueError, 'action = {"kick": 1}: unknown variant'),
        (lambda leg: leg.disturb({}), ValueError, "action = {}"),
        (lambda leg: Leg.can("can0", -1), ValueError, "leg = -1 is none of 1 to 6"),
        (lambda leg: leg.calibrate_cell(-1, [0, 1], print), ValueError, "cell = -1"),
        (lambda leg: leg.calibrate_cell(1, [0, np.nan], pytest.fail), ValueError, "weights_kg holds NaN at index 1"),
        (lambda leg: leg.calibrate_cell(1, [], pytest.fail), LegError, "two different weights"),
        (lambda leg: leg.calibrate_cell(4, [0, 1], print), ValueError, "cell = 4"),
        (lambda leg: leg.calibrate_cell(1, [0, 1], print, save=True), ValueError, "save is given without set"),
        (lambda leg: leg.calibrate_cell(1, [1, 1], pytest.fail), LegError, "two different weights"),
        (lambda leg: leg.calibrate_motors(print, 3), TypeError, "rig is no name"),
        (lambda leg: leg.jog(4, 1.0), ValueError, "motor = 4 is none of 1, 2 and 3"),
        (lambda leg: leg.jog(1, np.nan), ValueError, "travel_mm = NaN"),
        (lambda leg: leg.jog(1, 11.0), Refused, "no more than 10 mm"),
        (lambda leg: leg.jog(1, 1.0, volts=np.inf), ValueError, "volts = inf"),
        (lambda leg: leg.wait(-1), ValueError, "seconds = -1"),
        (lambda leg: Leg.emulated(3), TypeError, "rig is no name"),
    ],
)
def test_an_argument_is_refused_by_its_name(call, error, words):
    with pytest.raises(error) as refusal:
        call(Leg.emulated())
    assert words in str(refusal.value)
