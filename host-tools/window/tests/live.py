#!/usr/bin/env python3
"""Does with a live leg what a user does: watches it, unlocks it, drives it, stops it. The leg is simulated behind `leg ui`.

    tests/live.py DIR           DIR has the page; $LEG is the program `leg`, ../../target/debug/leg if it is not set
    tests/live.py DIR --keep    writes the picture anew: look at it before you commit
"""

import argparse
import contextlib
import json
import os
import pathlib
import socket
import subprocess
import time
import urllib.parse

from browser import ESCAPE, Page
from webdriver import Browser

HERE = pathlib.Path(__file__).resolve().parent
LEG = HERE.parents[2] / "target" / "debug" / "leg"

# Time in which a leg whose page has gone is held, s.
HELD_S = 5.0

# So often something is tried that a busy machine may spoil.
TRIES = 8


class Served:
    """`leg ui` with a simulated leg."""

    def __init__(self, page):
        command = [os.environ.get("LEG", LEG), "--json", "ui", "--on", "sim", "--no-open", "--page", page]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.url = json.loads(self.process.stdout.readline())["url"]
        page, self.leg = self.url.split("#leg=")
        self.origin = page.rstrip("/")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self):
        self.process.terminate()
        self.process.wait()


def answer(address, origin):
    """The status of the answer to a page that asks for the leg."""
    parts = urllib.parse.urlsplit(address)
    head = [
        f"GET {parts.path} HTTP/1.1",
        f"Host: {parts.netloc}",
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Version: 13",
        f"Origin: {origin}",
    ]
    with socket.create_connection((parts.hostname, parts.port), 10) as line:
        line.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
        return int(line.recv(1000).split()[1])


def strangers(served):
    """Only this program's own page is let in, and only by the address that was printed."""
    assert answer(served.leg, served.origin) == 101
    assert answer(served.leg, "http://example.org") == 403
    assert answer(served.leg[:-1] + "x", served.origin) == 403
    print("strangers are refused")


def watch(page):
    """A leg that is not unlocked is shown, and takes no command."""
    leg = page.wait_leg("is heard", lambda leg: leg["live"] and leg["time_s"] > 0)
    assert leg["locked"] and leg["drives"] == [False, False], leg
    places = page.state()["places"]
    assert "guide_payload" not in places and "cut_1" not in places and "rate" not in places
    state = leg["state"]
    page.press("home")
    time.sleep(0.5)
    assert page.state()["leg"]["state"] == state
    print(f"{leg['live']} is {state}, and locked")


def unlock(page):
    page.press("unlock")
    page.wait_leg("is unlocked", lambda leg: leg["drives"] == [True, False] and not leg["locked"])


def activate(page):
    """Brings the leg to where it follows commands."""
    page.press("arm" if page.state()["leg"]["state"] == "disarmed" else "clear")
    time.sleep(0.5)
    if page.state()["leg"]["state"] == "disarmed":
        page.press("home")
    page.wait_leg("follows commands", lambda leg: leg["state"] == "active", 60)


def drag(page):
    left, top, right, bottom = page.rect("workspace")
    middle, width = ((left + right) / 2, (top + bottom) / 2), right - left
    page.browser.drag(middle, (middle[0] + 0.2 * width, middle[1] - 0.1 * width))
    near = lambda leg: leg["tilt_deg"] > 8 and abs(leg["azimuth_deg"] - 27) < 8 and leg["error_mm"] < 2
    leg = page.wait_leg("goes to the target", near)
    assert leg["refusal"] is None, leg["refusal"]
    print(f"dragged to azimuth {leg['azimuth_deg']:.1f}°, tilt {leg['tilt_deg']:.1f}°")


def go_on(page):
    """Goes on after a stop. A busy machine may keep a page from drawing for so long that its leg is held once more."""
    for _ in range(TRIES):
        page.press("clear")
        time.sleep(0.4)
        if page.state()["leg"]["state"] == "active":
            return
    raise AssertionError(f"does not go on: {page.state()['leg']}")


def is_stopped(driver, stop, what):
    """Whether it is the stop that holds the leg, and not a fault."""
    for _ in range(TRIES):
        go_on(driver)
        stop()
        leg = driver.wait_leg(what, lambda leg: leg["state"] == "held")
        if not leg["faults"]:
            print(what)
            return
    raise AssertionError(f"not seen: {what}; {leg}")


def stops(page):
    for key, name in ((" ", "space"), (ESCAPE, "Escape")):
        is_stopped(page, lambda: page.browser.key(key), f"is stopped by {name}")


def second_page(served, page):
    """Another page sees who drives, commands nothing, and stops the leg all the same."""
    # Two browsers that draw by the processor alone: small ones keep each other from drawing less.
    page.browser.resize(1000, 560)
    with Browser(1000, 560) as browser:
        other = Page(browser, False)
        other.open(served.url)
        leg = other.wait_leg("sees the driver", lambda leg: leg["drives"] == [False, True])
        assert "Another page" in leg["locked"], leg
        go_on(page)
        other.press("disarm")
        other.press("unlock")
        time.sleep(0.5)
        leg = other.state()["leg"]
        assert leg["state"] in ("active", "held") and leg["drives"] == [False, True], leg
        is_stopped(page, lambda: other.press("stop"), "is stopped by a page that does not drive")
        # The first page goes while the leg follows it.
        go_on(page)
        page.browser.open("about:blank")
        began = time.monotonic()
        leg = other.wait_leg("is held by itself", lambda leg: leg["state"] != "active")
        took_s = time.monotonic() - began
        print(f"the page that drove is gone: the leg is {leg['state']}, {', '.join(leg['faults'])}")
        assert leg["state"] == "held" and leg["faults"] == ["no command"] and took_s < HELD_S, (leg, took_s)
        other.wait_leg("is free", lambda leg: leg["drives"] == [False, False])
        unlock(other)
        go_on(other)
        lost(served, other)


def lost(served, page):
    served.end()
    leg = page.wait_leg("is lost", lambda leg: leg["failure"])
    assert "held by itself" in leg["failure"] and leg["locked"], leg
    print(f"`leg ui` has ended: {leg['failure']}")


def nobody(page, served):
    """An address behind which there is nobody."""
    page.browser.open("about:blank")
    page.browser.open(served)
    until = time.monotonic() + 20
    while not (page.state() or {}).get("empty") or "No connection" not in page.state()["empty"]:
        assert time.monotonic() < until, page.state()
        time.sleep(0.1)
    print(page.state()["empty"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    file = (arguments.directory / "index.html").resolve()
    with contextlib.ExitStack() as stack:
        served = stack.enter_context(Served(file))
        strangers(served)
        browser = stack.enter_context(Browser(1280, 720))
        browser.prefer("dark")
        page = Page(browser, arguments.keep)
        page.open(served.url)
        watch(page)
        unlock(page)
        activate(page)
        drag(page)
        time.sleep(1.0)
        page.picture("live")
        stops(page)
        second_page(served, page)
        errors = [entry for entry in browser.log() if entry["level"] == "SEVERE"]
        assert not errors, errors
        nobody(page, f"{file.as_uri()}#leg=ws://127.0.0.1:9/x")
    print("all of it holds")


if __name__ == "__main__":
    main()
