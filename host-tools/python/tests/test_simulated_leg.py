"""The simulated leg: commands, what it answers, what is seen of it, copies and threads."""

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from tendon_leg import SIGNALS, STATES, TICKS_PER_SECOND, LegError, LegFault, LegTimeout, Refused, Rig, SimulatedLeg

#: Of a thread of Linux that reads it: ns on a processor, ns that it waited for one, and how often.
THREAD_TIMES = Path("/proc/thread-self/schedstat")


def armed(**start):
    leg = SimulatedLeg("table1", **start)
    leg.arm()
    return leg


def circle(seconds=2.0):
    time_s = np.arange(0.0, seconds + 0.005, 0.01)
    return np.column_stack([time_s, 72.0 * time_s, np.full_like(time_s, 20.0)])


def bits(leg):
    return {name: np.asarray(leg.read(name)).tobytes() for name in SIGNALS}


def test_a_slack_leg_is_homed_moved_stopped_cleared_and_disarmed():
    leg = SimulatedLeg("table1", slack=True)
    assert leg.state == "disarmed" and not leg.telemetry()["homed"]
    leg.home()
    assert leg.state == "active" and leg.telemetry()["homed"]
    leg.move(azimuth_deg=30.0, tilt_deg=20.0)
    truth = leg.truth()
    # What homing leaves of error in the zero: the bound of the ready scenario `homing`, 0.04 mm at 219 mm.
    assert truth["tilt_true_deg"] == pytest.approx(20.0, abs=0.0105)
    assert truth["azimuth_true_deg"] == pytest.approx(30.0, abs=0.0105 / np.sin(np.radians(20.0)))
    leg.stop()
    assert leg.state == "held"
    leg.clear()
    assert leg.state == "active"
    leg.disarm()
    assert leg.state == "disarmed"


def test_slow_settings_have_the_time_that_they_take():
    def slow(**control):
        values = Rig("table1").to_dict()
        values["control"] = control
        leg = SimulatedLeg(Rig.from_dict(values))
        leg.arm()
        return leg

    leg = slow(motion={"pretension_rate_n_per_s": 0.5})
    begun_s = leg.time_s
    leg.pretension(110.0)
    assert leg.time_s - begun_s == pytest.approx(80.0, abs=5.0)
    leg = slow(motion={"speed_rad_per_s": 0.01}, limits={"ramp_m_per_s": 9e-5})
    leg.move(0.0, 29.0)
    begun_s = leg.time_s
    leg.disarm()
    assert leg.state == "disarmed" and leg.time_s - begun_s > 60.0


def test_a_refusal_has_the_firmwares_words():
    leg = SimulatedLeg("table1")
    with pytest.raises(Refused) as refusal:
        leg.move(30.0, 20.0)
    told = refusal.value
    assert (told.reason, told.remedy) == ("the leg is disarmed", "arm it")
    assert (told.code, told.name) == ((6, 2), "Command.State")
    with pytest.raises(Refused, match="the leg does not know its zero; home it"):
        SimulatedLeg("table1", slack=True).arm()
    with pytest.raises(Refused, match="the leg cannot lean that far"):
        armed().move(0.0, 80.0)


def test_a_fault_has_code_name_and_remedy():
    leg = armed()
    leg.fault("cell_dead", 2)
    leg.run(0.2)
    assert leg.state == "held"
    with pytest.raises(LegFault) as fault:
        leg.move(0.0, 10.0)
    told = fault.value
    assert told.code in [row["code"] for row in leg.faults]
    assert told.name in ("saturated load cell", "jump of a tension", "stuck load cell")
    assert told.remedy and told.cause and told.state == "held"
    with pytest.raises(LegFault):
        leg.clear()
    leg.repair("cell_dead", 2)
    leg.run(0.2)
    leg.clear()
    assert leg.state == "active"


def test_a_fault_in_mid_move_ends_the_wait():
    leg = armed()
    leg.move(90.0, 25.0, wait=False)
    leg.run(0.1)
    leg.emergency_stop(True)
    with pytest.raises(LegFault) as fault:
        leg.wait()
    assert (fault.value.code, fault.value.name, leg.state) == (23, "emergency stop", "off")


def test_a_wait_that_is_too_short_says_so():
    leg = armed()
    leg.move(90.0, 25.0, wait=False)
    with pytest.raises(LegTimeout, match="within 0.05 s"):
        leg.wait(timeout_s=0.05)
    leg.wait()
    assert leg.read("tilt_deg") == pytest.approx(25.0, abs=0.01)


def test_stiffness_and_payload_come_out():
    leg = armed()
    leg.stiffness(110.0)
    assert leg.read("stiffness_nm_per_rad") == pytest.approx(110.0, rel=0.01)
    leg.move(0.0, 20.0)
    leg.payload(1.5, over_s=0.5)
    leg.run(2.0)
    assert leg.read("payload_true_kg") == 1.5
    assert leg.read("payload_kg") == pytest.approx(1.5, abs=0.05)
    with pytest.raises(LegFault, match="stiffness out of reach"):
        leg.stiffness(1e4)


def test_a_report_tells_apart_what_was_commanded_and_what_is_asked_for_now():
    leg = SimulatedLeg("table1")
    leg.arm()
    leg.stiffness(95)
    leg.move(30, 20, wait=False)
    leg.run(0.3)
    told = leg.telemetry()
    assert told["tilt_commanded_deg"] == pytest.approx(20.0, abs=1e-3)
    assert told["azimuth_commanded_deg"] == pytest.approx(30.0, abs=1e-3)
    assert 0.1 < told["tilt_reference_deg"] < 19.0
    assert told["stiffness_commanded_nm_per_rad"] == 95.0 and np.isnan(told["pretension_commanded_n"])
    assert told["tip_commanded_mm"] == pytest.approx(leg.read("tip_commanded_mm"), abs=1e-3)
    leg.hold()
    leg.run(1.0)
    told = leg.telemetry()
    assert told["direction_commanded"] == pytest.approx(told["direction_reference"])
    assert told["tilt_commanded_deg"] < 19.0


def test_silence_brings_an_armed_leg_to_rest():
    leg = armed()
    leg.silence(True)
    leg.run(2.0)
    assert [fault["name"] for fault in leg.faults] == ["no command"]


def test_a_path_is_followed_to_its_end():
    leg = armed(payload_kg=1.0)
    leg.record(["path_error_mm", "tip_true_mm"], every_ticks=8)
    leg.follow(circle())
    seen = leg.recording()
    on_path = np.isfinite(seen["path_error_mm"])
    assert on_path.sum() == pytest.approx(2000, abs=2)
    # The bound of the ready scenario `circle`.
    assert seen["path_error_mm"][on_path].max() < 0.05
    assert not leg.following and leg.state == "active"
    assert leg.read("tip_error_mm") < 0.05


def test_a_path_changes_the_pretension_on_the_way():
    leg = armed(payload_kg=1.0)
    points = circle()
    leg.record(["path_error_mm", "pretension_n"], every_ticks=8)
    leg.follow(points, pretension_n=np.linspace(70.0, 85.0, len(points)))
    seen = leg.recording()
    on_path = np.isfinite(seen["path_error_mm"])
    assert seen["path_error_mm"][on_path].max() < 0.2
    assert np.ptp(seen["pretension_n"][on_path]) > 13.0
    assert leg.read("pretension_n") == pytest.approx(85.0, abs=0.1)


def test_a_path_is_left_by_a_hold():
    leg = armed()
    leg.follow(circle(), wait=False)
    assert leg.following
    leg.run(2.5)
    leg.hold()
    assert not leg.following and leg.state == "active"
    assert leg.faults == []


def test_a_path_beyond_a_limit_is_refused_before_the_leg_moves():
    leg = armed()
    points = circle()
    points[:, 0] *= 0.05  # four turns a second
    with pytest.raises(Refused, match=r"the path \d\.\d+ s after its start: .* more than speed_rad_per_s; take more time") as refusal:
        leg.follow(points)
    assert refusal.value.name == "Command.Point.Limit.Speed"
    assert leg.read("tilt_true_deg") < 0.01 and not leg.following


def test_a_recording_has_a_row_every_so_many_ticks():
    leg = armed()
    leg.record(["tip_true_mm", "tilt_deg", "load_nm"], every_ticks=40)
    before_s = leg.time_s
    leg.run(0.1)
    leg.step(3)
    seen = leg.recording()
    assert {name: array.shape for name, array in seen.items()} == {
        "time_s": (21,),
        "tip_true_mm": (21, 3),
        "tilt_deg": (21,),
        "load_nm": (21, 2),
    }
    assert seen["time_s"][0] == pytest.approx(before_s + 1 / TICKS_PER_SECOND)
    assert np.diff(seen["time_s"]) == pytest.approx(40 / TICKS_PER_SECOND)
    assert all(array.dtype == np.float64 for array in seen.values())


def test_every_signal_can_be_read_and_recorded():
    leg = armed()
    leg.record(list(SIGNALS), every_ticks=1)
    leg.step(1)
    seen = leg.recording()
    for name in SIGNALS:
        assert np.array_equal(seen[name][0], leg.read(name), equal_nan=True), name
    assert {*leg.truth(), *leg.telemetry()} >= {name for name in SIGNALS if not name.startswith(("tip_", "path_"))}
    assert STATES[int(leg.read("state_index"))] == leg.state == "active"


def test_equal_seeds_give_equal_bits_and_others_do_not():
    def run(seed):
        leg = armed(seed=seed)
        leg.move(30.0, 15.0)
        return bits(leg)

    assert run(1) == run(1)
    assert run(1)["tensions_n"] != run(2)["tensions_n"]


def test_a_step_is_as_many_ticks_of_a_run():
    stepped, ran = armed(), armed()
    for _ in range(100):
        stepped.step()
    ran.run(0.1)
    assert (stepped.ticks, bits(stepped)) == (ran.ticks, bits(ran))


def test_a_clone_goes_on_alike_and_apart():
    leg = armed(payload_kg=0.5)
    leg.follow(circle(), wait=False)
    leg.run(2.0)
    alike, pushed = leg.clone(), leg.clone()
    pushed.push(azimuth_deg=0.0, force_n=20.0, for_s=0.1)
    for each in (leg, alike, pushed):
        each.run(0.05)
    assert bits(leg) == bits(alike) != bits(pushed)


def test_ctrl_c_ends_a_long_run_between_two_ticks():
    leg = armed()
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        leg.run(3600.0)
    assert leg.state == "active" and 0.0 < leg.time_s < 3600.0
    leg.move(30.0, 10.0)


def test_other_threads_run_while_a_leg_is_stepped():
    leg, count = armed(), 0
    thread = threading.Thread(target=leg.run, args=(20.0,))
    thread.start()
    while thread.is_alive():
        count += 1
    assert count > 1000


def test_a_leg_in_another_thread_is_refused_by_name():
    leg, refusals = armed(), []

    def run():
        # The other thread may be reading it just then.
        done = False
        while not done:
            try:
                leg.run(20.0)
                done = True
            except LegError as refusal:
                refusals.append(str(refusal))

    thread = threading.Thread(target=run)
    thread.start()
    while thread.is_alive():
        try:
            leg.read("tip_true_mm")
        except LegError as refusal:
            refusals.append(str(refusal))
    assert refusals and all(text.startswith("another thread uses this leg") for text in refusals)


def test_many_legs_in_threads_do_what_one_does():
    def work(leg):
        leg.arm()
        leg.move(45.0, 10.0)

    legs = [SimulatedLeg("table1") for _ in range(8)]
    threads = [threading.Thread(target=work, args=(leg,)) for leg in legs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({tuple(bits(leg).items()) for leg in legs}) == 1


def in_two_threads(*seconds):
    """Two legs that run at once: for each the part of its time in which its thread had or awaited nothing but a processor, and when its
    call ended."""
    legs, together, seen = [armed(), armed()], threading.Barrier(2), {}

    def runnable_s():
        on_processor_ns, awaiting_one_ns, _ = map(int, THREAD_TIMES.read_text().split())
        return (on_processor_ns + awaiting_one_ns) / 1e9

    def work(number):
        together.wait()
        begin_s, before_s = time.perf_counter(), runnable_s()
        legs[number].run(seconds[number])
        after_s, end_s = runnable_s(), time.perf_counter()
        seen[number] = (after_s - before_s) / (end_s - begin_s), end_s

    threads = [threading.Thread(target=work, args=(number,)) for number in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return zip(*(seen[number] for number in (0, 1)), strict=True)


@pytest.mark.skipif(not THREAD_TIMES.exists(), reason="a system that does not tell what a thread waits for")
def test_two_threads_do_the_work_of_two_cores():
    # Whatever else the machine does: 0.7 each is 1.4 times the work where two cores are free. Of a leg that held the interpreter's lock one
    # thread would have half of its time at most.
    parts, _ = in_two_threads(4.0, 4.0)
    print(f"{sum(parts):.2f} times the work of one thread")
    assert min(parts) >= 0.7, parts


@pytest.mark.skipif(not THREAD_TIMES.exists(), reason="a system that does not tell what a thread waits for")
def test_a_short_call_ends_within_a_long_one():
    _, (long_end_s, short_end_s) = in_two_threads(20.0, 0.5)
    assert short_end_s < long_end_s


def test_a_command_to_a_leg_that_brakes_waits_until_it_stands():
    leg = armed()
    leg.move(azimuth_deg=30, tilt_deg=25, wait=False)
    leg.run(0.3)
    leg.stop()
    leg.clear()
    leg.move(azimuth_deg=30, tilt_deg=5)
    assert leg.truth()["tilt_true_deg"] == pytest.approx(5.0, abs=0.1)


def test_a_leg_whose_compensation_is_off_settles_where_it_sags_to():
    leg = SimulatedLeg("table1", azimuth_deg=30, tilt_deg=30, payload_kg=1.0)
    leg.compensation("off")
    leg.arm()
    leg.move(azimuth_deg=30, tilt_deg=20)
    sag_mm = leg.truth()["tip_error_mm"]
    assert 1.0 < sag_mm < 10.0
    leg.compensation("estimated")
    leg.move(azimuth_deg=30, tilt_deg=20)
    assert leg.truth()["tip_error_mm"] < 0.1
