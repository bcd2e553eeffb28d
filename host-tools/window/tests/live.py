#!/usr/bin/env python3
"""Does with a live leg what a user does: watches it, unlocks it, drives it, stops it. The leg is simulated behind `leg ui`.

    tests/live.py DIR           DIR has the page; $LEG is the program `leg`, ../../target/debug/leg if it is not set
    tests/live.py DIR --keep    writes the pictures anew: look at each before you commit
"""

import argparse
import contextlib
import json
import os
import pathlib
import subprocess
import tempfile
import time

from browser import ESCAPE, RIGS, Page, type_value
from sockets import Cutter, OldServer, Stranger, answer
from webdriver import Browser

HERE = pathlib.Path(__file__).resolve().parent
LEG = HERE.parents[2] / "target" / "debug" / "leg"

# What the leg of these tests is set to: a busy machine may stop a page for longer than the 0.2 s of the default. That a page tells
# its leg often enough for those is a test of its own, by counts.
PATIENT = "\n[control.limits]\ncommand_time_s = 2\n"

# Time of a leg in which it is held once its page has gone, s; and of the clock for which a page is hidden, so that its leg is held meanwhile.
HELD_S = 5.0
HIDDEN_S = 4.0

# A page that shows everything side by side, and is quickly drawn.
SMALL = (1000, 560)

# From the joint to the tip of a leg that was set to 191 mm below its plate.
TIP_MM = 220.0

# Time in which a leg does what it is commanded, and a page has drawn that, s.
ANSWER_S = 3.0

# So often something is tried that a busy machine may spoil.
TRIES = 8


class Served:
    """`leg ui` with a simulated leg."""

    def __init__(self, page):
        self.rig = tempfile.NamedTemporaryFile("w", suffix=".toml")
        self.rig.write((RIGS / "table1.toml").read_text() + PATIENT)
        self.rig.flush()
        command = [os.environ.get("LEG", LEG), "--json", "ui", "--on", "sim", "--rig", self.rig.name, "--no-open", "--page", page]
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
        self.rig.close()


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


def told(page, words):
    state = page.wait(words, lambda state: words in (state["setup"]["board_told"] or ""))
    return state["setup"]["board_told"]


def open_settings(page):
    page.press("setup")
    page.wait("there are pages", lambda state: "setup_settings" in state["places"])
    page.press("setup_settings")
    page.wait("there is the board", lambda state: "board_set" in state["places"])


def watched_board(page):
    """A page that does not drive sees the settings, and sends none."""
    open_settings(page)
    for name in ("board_read", "board_set", "board_keep"):
        page.press(name)
        time.sleep(0.3)
        state = page.state()["setup"]
        assert state["board_busy"] is None and state["board_told"] is None, state
    page.press("setup")


def board(served, page):
    """Reads, sets and keeps the settings of a board that is disarmed, by the page that drives."""
    open_settings(page)
    page.press("board_read")
    told(page, "Read from the board")
    type_value(page, "value_geometry.leg_mm", "-1")
    page.wait("it is refused", lambda state: state["setup"]["refused"])
    type_value(page, "value_geometry.leg_mm", "191")
    page.wait("it is changed", lambda state: state["setup"]["changed"] == ["geometry.leg_mm"])
    page.press("board_set")
    print(told(page, "found the same"))
    page.wait_leg("is so", lambda leg: abs(leg["tip_mm"] - TIP_MM) < 0.01)
    page.press("board_keep")
    print(told(page, "Kept"))
    page.picture("live_settings")
    page.browser.open("about:blank")
    page.open(served.url)
    page.wait_leg("is heard", lambda leg: leg["live"] and leg["time_s"] > 0)
    leg = page.state()["leg"]
    assert abs(leg["tip_mm"] - TIP_MM) < 0.01, "a page that comes later knows the settings"
    print("a page that comes later knows the settings")


def driven_board(page):
    """The settings of a leg that follows commands stay as they are."""
    open_settings(page)
    for name in ("board_set", "board_keep"):
        page.press(name)
        time.sleep(0.3)
        assert page.state()["setup"]["board_busy"] is None
    page.press("setup")
    page.wait("the leg is shown", lambda state: "arm" in state["places"])


def phone(page):
    """A phone held upright shows a live leg: who drives, the stop, and the commands behind tabs."""
    page.browser.resize(390, 844)
    page.wait("has tabs", lambda state: "tab_charts" in state["places"])
    places = page.state()["places"]
    assert "tab_try" not in places and "tab_break" not in places
    for name in ("stop", "origin", "leg", "tab_drive", "tab_setup"):
        left, _, right, bottom = places[name]
        assert 0 <= left < right <= 390 and bottom <= 844, (name, places[name])
    page.press("tab_drive")
    page.wait("has the disc", lambda state: "workspace" in state["places"])
    page.picture("live_phone")
    page.browser.resize(*SMALL)
    page.wait("is wide", lambda state: "tab_drive" not in state["places"])


def second_driver(served, page):
    """Another program with the address may watch. It is told that somebody drives, and what it sends is not passed on."""
    with Stranger(served.leg, served.origin) as other:
        assert "hello" in other.heard()
        other.say("drive")
        while "drives" not in (role := other.heard()):
            pass
        role = other.heard() if role == {"drives": False, "other_drives": False} else role
        assert role == {"drives": False, "other_drives": True}, role
        other.say(b"\x02\x01\x00")
        other.say(b"no frame")
        assert other.ended(), "bytes that are no frame end a connection"
    assert page.state()["leg"]["drives"] == [True, False]
    print("a second driver is told that another one drives")


def cut_socket(served, page):
    """The line between page and program is cut: the page says so, and takes no command any more."""
    page.browser.open("about:blank")
    with Cutter(served.leg) as cutter:
        page.open(f"{served.origin}/#leg={cutter.url}")
        page.wait_leg("is heard", lambda leg: leg["live"] and leg["time_s"] > 0)
        unlock(page)
        cutter.cut()
        # A page that is drawn once in seconds says first that its leg does not answer.
        leg = page.wait_leg("is lost", lambda leg: "connection is lost" in (leg["failure"] or ""))
        assert leg["locked"], leg
        print(f"cut: {leg['failure']}")
    page.browser.open("about:blank")
    page.open(served.url)
    page.wait_leg("is free again", lambda leg: leg["live"] and leg["drives"] == [False, False])
    unlock(page)


def old_page(served, page):
    """A page of one version and a firmware of another do not guess."""
    page.browser.open("about:blank")
    with OldServer() as server:
        page.browser.open(f"{served.origin}/#leg={server.url}")
        words = empty(page, "different versions")
        assert "Build the page anew" in words, words
        print(words)
    page.browser.open("about:blank")
    page.open(served.url)
    unlock(page)


def empty(page, words):
    """Why a page shows no leg."""
    until = time.monotonic() + 20
    while words not in ((page.state() or {}).get("empty") or ""):
        assert time.monotonic() < until, page.state()
        time.sleep(0.1)
    return page.state()["empty"]


def activate(page):
    """Brings the leg to where it follows commands. A busy machine may hold it on the way: its page then drew for too long."""
    for _ in range(TRIES):
        page.press("arm" if page.state()["leg"]["state"] == "disarmed" else "clear")
        time.sleep(0.5)
        if page.state()["leg"]["state"] == "disarmed":
            page.press("home")
            time.sleep(0.5)
        leg = page.wait_leg("ends what it does", lambda leg: leg["state"] in ("active", "held", "disarmed"), 60)
        if leg["state"] == "active":
            return
    raise AssertionError(f"does not follow commands: {leg}")


def drag(page):
    near = lambda leg: leg["tilt_deg"] > 8 and abs(leg["azimuth_deg"] - 27) < 8 and leg["error_mm"] < 2
    for _ in range(TRIES):
        left, top, right, bottom = page.rect("workspace")
        middle, width = ((left + right) / 2, (top + bottom) / 2), right - left
        page.drag(middle, (middle[0] + 0.2 * width, middle[1] - 0.1 * width))
        leg = page.wait_leg("goes to the target", lambda leg: near(leg) or leg["state"] == "held")
        if leg["state"] == "active":
            assert leg["refusal"] is None, leg["refusal"]
            print(f"dragged to azimuth {leg['azimuth_deg']:.1f}°, tilt {leg['tilt_deg']:.1f}°")
            return
        assert leg["faults"] == ["no command"], leg
        go_on(page)
    raise AssertionError(f"does not stay at the target: {leg}")


def go_on(page):
    """Goes on after a stop. A busy machine may keep a page from drawing for so long that its leg is held once more."""
    for _ in range(TRIES):
        page.press("clear")
        until = time.monotonic() + ANSWER_S
        while time.monotonic() < until:
            if page.state()["leg"]["state"] == "active":
                return
            time.sleep(0.05)
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


def measure(page):
    """A motor of a disarmed leg is measured; its swing, of which a page hears too few reports, is not."""
    page.press("disarm")
    page.wait_leg("is disarmed", lambda leg: leg["state"] == "disarmed", 60)
    page.press("setup")
    page.press("setup_steps")
    page.press("guide_tune")
    page.wait_for("tune_start")
    assert "tune_swings" not in page.state()["places"]
    # It takes no press before the supply's voltage has come over the line.
    for _ in range(TRIES):
        page.press("tune_start")
        page.wait_frames()
        if "tune_start" not in page.state()["places"]:
            break
    else:
        raise AssertionError("it is not begun")
    ended = page.wait("it is measured", lambda state: {"tune_result", "tune_failed"} & set(state["places"]), 200)
    assert "tune_failed" not in ended["places"], ended["setup"]["measure_failed"]
    page.press("tune_take")
    changed = page.wait("the settings have it", lambda state: state["setup"]["changed"])["setup"]["changed"]
    print(f"measured: {', '.join(changed)}")
    page.press("setup_settings")
    page.press("settings_all")
    page.press("setup")
    page.wait("the leg is shown", lambda state: "arm" in state["places"])
    activate(page)


def second_page(served, page):
    """Another page sees who drives, commands nothing, and stops the leg all the same."""
    with Browser(*SMALL) as browser:
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
        began_s = other.state()["leg"]["time_s"]
        leg = other.wait_leg("is held by itself", lambda leg: leg["state"] != "active")
        took_s = leg["time_s"] - began_s
        print(f"the page that drove is gone: the leg is {leg['state']}, {', '.join(leg['faults'])}")
        assert leg["state"] == "held" and leg["faults"] == ["no command"] and took_s < HELD_S, (leg, took_s)
        other.wait_leg("is free", lambda leg: leg["drives"] == [False, False])
        unlock(other)
        go_on(other)
        lost(served, other)


def lost(served, page):
    served.end()
    leg = page.wait_leg("is lost", lambda leg: "held by itself" in (leg["failure"] or ""))
    assert leg["locked"], leg
    page.press("stop")
    time.sleep(0.3)
    assert not (errors := severe(page.browser)), errors
    print(f"`leg ui` has ended: {leg['failure']}")


# Counts how often the page shows its leg life, while it is hidden and otherwise, and how often it is hidden.
COUNTED = """
const shown = wasm_bindgen.LegWindow.prototype, show_life = shown.show_life;
const counts = window.counts = {hidden: 0, seen: 0, life_of_hidden: 0};
document.addEventListener("visibilitychange", () => { counts.hidden += document.hidden; });
shown.show_life = function (now_s) {
  counts[document.hidden ? "life_of_hidden" : "seen"] += 1;
  return show_life.call(this, now_s);
};
"""


def hidden(page):
    """A page behind another one falls silent at once, not only once it stands still, and its leg is held."""
    go_on(page)
    page.browser.run(COUNTED)
    before_s = page.state()["leg"]["time_s"]
    with page.browser.covered():
        time.sleep(HIDDEN_S)
    leg = page.wait_leg("is heard again", lambda leg: leg["time_s"] > before_s + HIDDEN_S - 1)
    assert leg["state"] == "held", leg
    counts = page.browser.run("return window.counts")
    assert counts["hidden"] == 1 and counts["seen"] > 0 and counts["life_of_hidden"] == 0, counts
    assert leg["faults"] == ["no command"] and leg["drives"] == [True, False], leg
    print("a hidden page falls silent: the leg is held")
    go_on(page)


def severe(browser):
    """What the browser complains of."""
    return [entry for entry in browser.log() if entry["level"] == "SEVERE"]


def nobody(page, served):
    """An address behind which there is nobody."""
    page.browser.open("about:blank")
    page.browser.open(served)
    print(empty(page, "No connection"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    file = (arguments.directory / "index.html").resolve()
    with contextlib.ExitStack() as stack:
        served = stack.enter_context(Served(file))
        strangers(served)
        # What is drawn by the processor alone keeps the page from telling its leg that it is there: little is drawn.
        browser = stack.enter_context(Browser(*SMALL))
        browser.prefer("dark")
        page = Page(browser, arguments.keep)
        page.open(served.url)
        # First what needs no leg that is driven, which a busy machine may hold.
        watch(page)
        watched_board(page)
        unlock(page)
        board(served, page)
        unlock(page)
        phone(page)
        second_driver(served, page)
        cut_socket(served, page)
        old_page(served, page)
        nobody(page, f"{file.as_uri()}#leg=ws://127.0.0.1:9/x")
        # A leg that was set anew would have to home: another one does not.
        served = stack.enter_context(Served(file))
        page.browser.open("about:blank")
        page.open(served.url)
        watch(page)
        unlock(page)
        activate(page)
        drag(page)
        time.sleep(1.0)
        go_on(page)
        page.picture("live")
        driven_board(page)
        stops(page)
        hidden(page)
        measure(page)
        second_page(served, page)
        errors = severe(browser)
        assert not [error for error in errors if "127.0.0.1:9" not in error["message"]], errors
    print("all of it holds")


if __name__ == "__main__":
    main()
