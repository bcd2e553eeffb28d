"""Stepping by the millisecond costs little beside the ticks themselves."""

import time

import numpy as np
from tendon_leg import Rig, SimulatedLeg


def shortest_s(work):
    """Of some repetitions: nothing but other work on the machine makes one longer."""
    times_s = []
    for _ in range(5):
        begin_s = time.perf_counter()
        work()
        times_s.append(time.perf_counter() - begin_s)
    return min(times_s)


def test_stepped_by_the_millisecond_a_leg_is_as_fast_as_in_one_call():
    leg = SimulatedLeg("table1")
    leg.arm()

    def step():
        for _ in range(2000):
            leg.step(8)

    stepped_s, ran_s = shortest_s(step), shortest_s(lambda: leg.run(2.0))
    print(f"{16000 / ran_s:.0f} ticks/s in one call, {ran_s / stepped_s:.0%} of that stepped by the millisecond")
    assert ran_s / stepped_s >= 0.7


def test_a_pose_of_many_costs_no_more_than_one_of_a_map():
    rig = Rig("table1")
    number = np.arange(300_000)
    azimuth_deg, tilt_deg = 360.0 * ((number * 0.6180339887) % 1.0), 30.0 * np.sqrt((number + 0.5) / len(number))
    outputs = ["tensions_n", "level_range_n", "feasible", "bending_stiffness_nm_per_rad", "deviation_m"]
    evaluated_s = shortest_s(lambda: rig.evaluate(azimuth_deg, tilt_deg, 1.0, outputs=outputs))
    # The same poses on the same cores; what Python gets of a map is what Rust made, copied.
    mapped_s = shortest_s(lambda: rig.workspace_map(1.0, azimuths=1000, tilts=301))
    print(f"{1e9 * evaluated_s / 3e5:.0f} ns a pose, {evaluated_s / mapped_s:.2f} of a map's")
    assert evaluated_s <= 1.2 * mapped_s
