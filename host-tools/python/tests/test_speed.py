"""Stepping by the millisecond costs little beside the ticks themselves."""

import time

from tendon_leg import SimulatedLeg


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
