"""What Python adds to the time of the simulated leg and of the model, beside the same work in Rust alone."""

import json
import subprocess
import time
from pathlib import Path

import numpy as np
from tendon_leg import Rig, SimulatedLeg

PACKAGE = Path(__file__).parents[1]
REPETITIONS, MOST_REPETITIONS = 5, 30
TICKS = 16_000
AZIMUTHS, TILTS = 1000, 1001


def in_rust(ticks, azimuths, tilts):
    """What so many ticks and a map take in Rust alone, s; cargo builds what measures it."""
    rates = ["cargo", "run", "--release", "--locked", "--quiet", "--package", "leg-rates", "--"]
    ended = subprocess.run([*rates, *map(str, (ticks, azimuths, tilts))], cwd=PACKAGE, stdout=subprocess.PIPE, check=True)
    return json.loads(ended.stdout)


def shortest_s(rust, python, holds):
    """Of some repetitions of Rust's work, and of Python's until it holds: nothing but other work on the machine makes one longer."""
    rust_s, python_s = min(rust() for _ in range(REPETITIONS)), float("inf")
    for _ in range(MOST_REPETITIONS):
        python_s = min(python_s, python())
        if holds(rust_s, python_s):
            break
    return rust_s, python_s


def timed(work):
    def run():
        begin_s = time.perf_counter()
        work()
        return time.perf_counter() - begin_s

    return run


def test_stepped_by_the_millisecond_a_leg_has_seven_tenths_of_the_rate_of_rust():
    leg = SimulatedLeg("table1")
    leg.arm()

    def step():
        for _ in range(TICKS // 8):
            leg.step(8)

    def holds(rust_s, python_s):
        return rust_s >= 0.7 * python_s

    rust_s, python_s = shortest_s(lambda: in_rust(TICKS, 3, 2)["ticks_s"], timed(step), holds)
    print(f"{TICKS / rust_s:.0f} ticks/s in Rust, {rust_s / python_s:.0%} of that stepped by the millisecond")
    assert holds(rust_s, python_s), (rust_s, python_s)


def test_a_pose_of_a_million_costs_no_more_than_one_of_a_map_of_rust():
    rig = Rig("table1")
    number = np.arange(1_000_000)
    azimuth_deg, tilt_deg = 360.0 * ((number * 0.6180339887) % 1.0), 30.0 * np.sqrt((number + 0.5) / len(number))
    outputs = ["tensions_n", "level_range_n", "feasible", "bending_stiffness_nm_per_rad", "deviation_m"]
    evaluate = timed(lambda: rig.evaluate(azimuth_deg, tilt_deg, 1.0, outputs=outputs))
    # The vertical is one pose of the map.
    mapped = 1 + AZIMUTHS * (TILTS - 1)

    def holds(map_s, evaluated_s):
        return evaluated_s / len(number) <= 1.2 * map_s / mapped

    map_s, evaluated_s = shortest_s(lambda: in_rust(1, AZIMUTHS, TILTS)["map_s"], evaluate, holds)
    map_ns, pose_ns = 1e9 * map_s / mapped, 1e9 * evaluated_s / len(number)
    print(f"{map_ns:.0f} ns a pose of a map in Rust, {pose_ns / map_ns:.2f} of that a pose in Python")
    assert holds(map_s, evaluated_s), (map_s, evaluated_s)
