"""A leg on a port for programs of asyncio."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from os import PathLike
from typing import Any, Self, TypeVar

from numpy.typing import ArrayLike

from ._native import Leg, Rig

Result = TypeVar("Result")


class AsyncLeg:
    """`Leg`, whose calls are awaited: other tasks go on meanwhile.

    One call at a time: a second one waits for the first. `stop` does not wait: it ends the call that drives the leg. A task
    that is cancelled in a call stops the leg, which is in hold then.
    """

    def __init__(self, leg: Leg) -> None:
        """Of a leg that is open, which belongs to this from now on."""
        self._leg = leg
        # The leg's calls belong to one thread at a time.
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="leg")

    @classmethod
    async def open(cls, port: str | None = None) -> Self:
        """As `Leg.open`."""
        return cls(await asyncio.to_thread(Leg.open, port))

    @classmethod
    async def emulated(cls, rig: str | PathLike[str] | Rig | None = None, *, slack: bool = False) -> Self:
        """As `Leg.emulated`."""
        return cls(await asyncio.to_thread(lambda: Leg.emulated(rig, slack=slack)))

    async def home(self) -> dict[str, Any]:
        """As `Leg.home`."""
        return await self._call(self._leg.home)

    async def move(
        self,
        azimuth_deg: float,
        tilt_deg: float,
        *,
        pretension_n: float | None = None,
        stiffness_nm_per_rad: float | None = None,
        towards_deg: float | None = None,
    ) -> dict[str, Any]:
        """As `Leg.move`."""
        return await self._call(
            lambda: self._leg.move(
                azimuth_deg,
                tilt_deg,
                pretension_n=pretension_n,
                stiffness_nm_per_rad=stiffness_nm_per_rad,
                towards_deg=towards_deg,
            )
        )

    async def stiffness(self, nm_per_rad: float, towards_deg: float | None = None) -> dict[str, Any]:
        """As `Leg.stiffness`."""
        return await self._call(lambda: self._leg.stiffness(nm_per_rad, towards_deg))

    async def follow(self, points: ArrayLike, *, lead_s: float = 0.2) -> dict[str, Any]:
        """As `Leg.follow`."""
        return await self._call(lambda: self._leg.follow(points, lead_s=lead_s))

    async def hold(self) -> dict[str, Any]:
        """As `Leg.hold`."""
        return await self._call(self._leg.hold)

    async def stop(self) -> None:
        """As `Leg.stop`, whatever call is under way."""
        await asyncio.to_thread(self._leg.stop)

    async def disarm(self) -> None:
        """As `Leg.disarm`."""
        await self._call(self._leg.disarm)

    async def clear(self) -> None:
        """As `Leg.clear`."""
        await self._call(self._leg.clear)

    async def telemetry(self) -> dict[str, Any]:
        """As `Leg.telemetry`."""
        return await self._call(self._leg.telemetry)

    async def close(self) -> None:
        """As `Leg.close`, once the call that is under way has ended."""
        await self._call(self._leg.close)
        self._thread.shutdown()

    async def __aenter__(self) -> Self:
        """The leg itself."""
        return self

    async def __aexit__(self, *_exception: object) -> None:
        """Closes the connection."""
        await self.close()

    async def _call(self, call: Callable[[], Result]) -> Result:
        called = self._thread.submit(call)
        ended = asyncio.wrap_future(called)
        try:
            return await asyncio.shield(ended)
        except asyncio.CancelledError:
            if not called.cancel():
                await asyncio.to_thread(self._leg.stop)
                await asyncio.wait([ended])
                # The error with which a stop ends a call is nobody's.
                ended.exception()
            raise
