"""A leg on a port, awaited."""

import asyncio
from contextlib import ExitStack

import pytest
from tendon_leg import AsyncLeg, LegError
from test_port import emulator, needs_leg


def test_other_tasks_go_on_while_the_leg_moves():
    async def main():
        ticks = 0

        async def count():
            nonlocal ticks
            while True:
                await asyncio.sleep(0.001)
                ticks += 1

        counting = asyncio.create_task(count())
        async with await AsyncLeg.emulated() as leg:
            await leg.move(azimuth_deg=30, tilt_deg=20)
            await leg.follow([[0.0, 30.0, 20.0], [0.5, 30.0, 18.0], [1.0, 30.0, 18.0]])
            seen = await leg.telemetry()
            assert seen["state"] == "keeping station"
            assert seen["tilt_deg"] == pytest.approx(18.0, abs=0.1)
        counting.cancel()
        return ticks

    assert asyncio.run(main()) > 10


def test_two_legs_move_at_once_and_one_call_waits_for_the_other():
    async def main():
        legs = await asyncio.gather(AsyncLeg.emulated(), AsyncLeg.emulated("universal"))
        moves = [leg.move(azimuth_deg=azimuth, tilt_deg=15) for leg in legs for azimuth in (0, 90)]
        reached = await asyncio.gather(*moves)
        for leg in legs:
            await leg.close()
        return [one["azimuth_deg"] for one in reached]

    off_deg = [(found - asked + 180) % 360 - 180 for found, asked in zip(asyncio.run(main()), [0, 90, 0, 90], strict=True)]
    assert off_deg == pytest.approx([0, 0, 0, 0], abs=0.3)


def test_a_cancelled_call_and_a_stop_leave_the_leg_in_hold():
    async def main():
        async with await AsyncLeg.emulated() as leg:
            with pytest.raises(TimeoutError):
                # Long enough for a busy machine to begin it.
                async with asyncio.timeout(1.0):
                    await leg.follow([[60.0 * t, 0.0, 10.0 * t / 60.0] for t in range(61)])
            cancelled = (await leg.telemetry())["state"]
            # What only asks does not stop the leg when it is cancelled.
            await leg.clear()
            await leg.move(azimuth_deg=0, tilt_deg=5)
            asking = asyncio.create_task(leg.telemetry())
            await asyncio.sleep(0)
            asking.cancel()
            with pytest.raises(asyncio.CancelledError):
                await asking
            assert (await leg.telemetry())["state"] == "keeping station"
            await leg.stop()
            await leg.clear()
            moving = asyncio.create_task(leg.follow([[t, 0.0, 10.0 * t / 60.0] for t in range(61)]))
            await stopped(leg, moving)
            return cancelled, (await leg.telemetry())["state"]

    assert asyncio.run(main()) == ("held", "held")


async def stopped(leg, moving):
    await asyncio.sleep(0.05)
    # Until it has begun, a stop is over before.
    while not moving.done():
        await leg.stop()
    with pytest.raises(LegError):
        await moving


async def homed_moved_and_stopped(leg):
    assert (await leg.home())["homed"]
    assert (await leg.move(azimuth_deg=30, tilt_deg=5))["tilt_deg"] == pytest.approx(5.0, abs=0.1)
    moving = asyncio.create_task(leg.follow([[t, 30.0, 5.0 + t / 10.0] for t in range(61)]))
    await stopped(leg, moving)
    assert (await leg.telemetry())["state"] == "held"


def test_a_leg_on_a_bus_is_awaited():
    async def main():
        async with await AsyncLeg.emulated(slack=True, can=3) as leg:
            await homed_moved_and_stopped(leg)

    asyncio.run(main())


@needs_leg
# QEMU alone: it needs most of a core to keep up with real time.
@pytest.mark.parametrize("emulators", [([], ["--tcp"]), (["--on", "qemu"],)])
def test_legs_on_ports_are_awaited_wherever_their_firmware_runs(emulators):
    async def drive(port):
        async with await AsyncLeg.open(port) as leg:
            await homed_moved_and_stopped(leg)

    async def main(ports):
        await asyncio.gather(*map(drive, ports))

    with ExitStack() as running:
        asyncio.run(main([running.enter_context(emulator("--slack", *each)) for each in emulators]))


def test_a_closed_leg_is_refused_by_name():
    async def main():
        async with await AsyncLeg.emulated() as leg:
            pass
        for call in (leg.telemetry, leg.home, leg.hold, leg.stop):
            with pytest.raises(LegError, match="this leg is closed"):
                await call()
        await leg.close()

    asyncio.run(main())
