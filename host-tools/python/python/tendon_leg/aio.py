"""A leg on a port for programs of asyncio."""

import asyncio
import functools
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Concatenate, ParamSpec, Self, TypeVar

from ._native import Leg

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def _opened(open_leg: Callable[Arguments, Leg]) -> Callable[Arguments, Awaitable["AsyncLeg"]]:
    """Opens a leg while other tasks go on."""

    @functools.wraps(open_leg)
    async def opened(*args: Arguments.args, **kwargs: Arguments.kwargs) -> "AsyncLeg":
        return AsyncLeg(await asyncio.to_thread(open_leg, *args, **kwargs))

    return opened


def _awaited(
    method: Callable[Concatenate[Leg, Arguments], Result], *, drives: bool
) -> Callable[Concatenate["AsyncLeg", Arguments], Awaitable[Result]]:
    """A method of `Leg` with the same arguments, awaited. One that drives the leg stops it when it is cancelled."""

    @functools.wraps(method)
    async def awaited(self: "AsyncLeg", /, *args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
        try:
            called = self._thread.submit(method, self._leg, *args, **kwargs)
        except RuntimeError:
            # The thread has ended with the leg, whose own refusal says so.
            return method(self._leg, *args, **kwargs)
        ended = asyncio.wrap_future(called)
        try:
            return await asyncio.shield(ended)
        except asyncio.CancelledError:
            if not called.cancel():
                if drives:
                    await asyncio.to_thread(self._leg.stop)
                await asyncio.wait([ended])
                # The error with which a stop ends a call is nobody's.
                ended.exception()
            raise

    return awaited


class AsyncLeg:
    """`Leg`, whose calls are awaited: other tasks go on meanwhile.

    One call at a time: a second one waits for the first. `stop` does not wait: it ends the call that drives the leg. A task
    that is cancelled in a call that drives the leg stops it; it is in hold then.
    """

    def __init__(self, leg: Leg) -> None:
        """Of a leg that is open, which belongs to this from now on."""
        self._leg = leg
        # The leg's calls belong to one thread at a time.
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="leg")

    open = staticmethod(_opened(Leg.open))
    can = staticmethod(_opened(Leg.can))
    emulated = staticmethod(_opened(Leg.emulated))

    home = _awaited(Leg.home, drives=True)
    move = _awaited(Leg.move, drives=True)
    stiffness = _awaited(Leg.stiffness, drives=True)
    follow = _awaited(Leg.follow, drives=True)
    hold = _awaited(Leg.hold, drives=True)
    disarm = _awaited(Leg.disarm, drives=True)
    clear = _awaited(Leg.clear, drives=False)
    telemetry = _awaited(Leg.telemetry, drives=False)
    scope = _awaited(Leg.scope, drives=False)
    sensors = _awaited(Leg.sensors, drives=False)
    wait = _awaited(Leg.wait, drives=False)
    disturb = _awaited(Leg.disturb, drives=False)
    settings = _awaited(Leg.settings, drives=False)
    settings_differences = _awaited(Leg.settings_differences, drives=False)
    set_settings = _awaited(Leg.set_settings, drives=False)
    calibrate_cell = _awaited(Leg.calibrate_cell, drives=False)
    calibrate_motors = _awaited(Leg.calibrate_motors, drives=False)
    jog = _awaited(Leg.jog, drives=True)
    _close = _awaited(Leg.close, drives=False)

    async def stop(self) -> None:
        """As `Leg.stop`, whatever call is under way."""
        await asyncio.to_thread(self._leg.stop)

    async def close(self) -> None:
        """As `Leg.close`, once the call that is under way has ended."""
        await self._close()
        self._thread.shutdown()

    async def __aenter__(self) -> Self:
        """The leg itself."""
        return self

    async def __aexit__(self, *_exception: Any) -> None:
        """Closes the connection."""
        await self.close()
