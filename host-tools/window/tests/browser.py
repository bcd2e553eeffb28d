#!/usr/bin/env python3
"""Does in a browser what a person does who has never seen the page, from disk and from a web server.

    tests/browser.py DIR                compares the pictures with those in tests/pictures
    tests/browser.py DIR --beside       in browsers beside each other, in less time: what CI runs
    tests/browser.py DIR --keep         writes those anew: look at them before you commit
"""

import argparse
import base64
import collections
import contextlib
import functools
import http.server
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time

from webdriver import Browser

HERE = pathlib.Path(__file__).resolve().parent
PICTURES = HERE / "pictures"
RIGS = HERE.parents[1] / "rigs"
GOLDEN_BITS = HERE.parents[2] / "tests" / "golden" / "scenario_bits.txt"

# What the page promises.
LOAD_S = 3.0
WIRE_BYTES = 8e6
# A machine that paints by its processor alone, and shares it, is not held to the 60 frames of a second of one with a
# graphics card: what the page itself takes for a frame, ticks, layout and triangles, is.
FRAME_MS = 1000 / 60

# So many frames are measured without painting.
COST_FRAMES = 120

# What is measured is the median of so many looks, one after the other; other programs may keep the processor for so many.
LOOKS = 3
MOST_LOOKS = 9

# How long the rate of a leg's time is measured for, s; how far a frame that is late may put it off; and the least of it that a page may be
# too slow for, so that it leaves the rest out.
RATE_S = 3.0
RATE_PART = 0.2
SLOW_PART = 0.3

# How far the leg's time may be behind the clock's.
REAL_TIME = 0.9

# Side of the blocks in which pictures are compared, pixels.
BLOCK = 8

# Mean difference of the colours of a block, from 0 to 255: another moment of the same state is below it.
TOLERANCE = 12

# What shows another number, or another stretch of time, in another moment: it is not compared.
CHANGING = ("readout", "tensions", "numbers", "charts", "stiffness", "pretension", "name", "trigger", "recording_time", "tune_result", "zero_result", "jog_result")

# What is left out of the time may be shown above it or to its right, pixels.
LEFT_OUT = (-30, -20, 130, 0)

# What is waited for comes at last on a machine that is as slow as it may be: a page may be drawn once in seconds there.
WAIT_S = 120.0

# A hundred frames of such a page.
READ_S = 600.0

# A motor and three pretensions are measured by a page that may be slow.
TUNED_S = 400.0

# A leg whose tip moves by less than that within the time of a swing rests, mm and s.
REST_MM = 0.2
SWING_S = 0.8

# How much of a slider's width its way takes, beside its value.
SLIDER_PART = 0.38

# Keys, as the WebDriver protocol has them.
TAB, ESCAPE, RIGHT, UP = "\ue004", "\ue00c", "\ue014", "\ue013"

# Widest picture that is kept.
KEPT_WIDTH = 1280


class Page:
    """The page, as its user sees it."""

    def __init__(self, browser, keep):
        self.browser = browser
        self.keep = keep

    def open(self, address):
        self.address = address
        began = time.monotonic()
        self.browser.open(address)
        self.wait("the leg is shown", lambda state: state["frames"] > 1 and state["places"])
        return time.monotonic() - began

    def state(self):
        script = "return window.leg_state ? window.leg_state() : null"
        return self.browser.run(script)

    def wait(self, what, done, limit_s=WAIT_S):
        until = time.monotonic() + limit_s
        while True:
            state = self.state()
            if state and state["leg"] and done(state):
                return state
            if time.monotonic() > until:
                raise AssertionError(f"not seen within {limit_s} s: {what}; {state}")
            time.sleep(0.05)

    def wait_for(self, name):
        """Waits until a control is shown, and stands still: what is above it may come or go."""
        seen = []

        def stands(state):
            seen.append((state["places"].get(name), state["frames"]))
            (first, since), (last, now) = seen[0], seen[-1]
            if last is None or last != first:
                seen.clear()
                return False
            return now >= since + 2

        self.wait(f"{name} is shown", stands)

    def wait_leg(self, what, done, limit_s=WAIT_S):
        return self.wait(what, lambda state: done(state["leg"]), limit_s)["leg"]

    def wait_for_rest(self, limit_s=2 * WAIT_S):
        """Waits until the leg does not swing any more."""
        seen = collections.deque()

        def rests(leg):
            seen.append((leg["time_s"], leg["error_mm"]))
            if seen[-1][0] - seen[0][0] < SWING_S:
                return False
            errors_mm = [error_mm for _, error_mm in seen]
            seen.popleft()
            return max(errors_mm) - min(errors_mm) < REST_MM

        self.wait_leg("rests", rests, limit_s)

    def rect(self, name):
        return self.state()["places"][name]

    def centre(self, name):
        left, top, right, bottom = self.rect(name)
        return (left + right) / 2, (top + bottom) / 2

    def press(self, name):
        self.wait_for(name)
        self.browser.click(*self.centre(name))

    def picture(self, name):
        """Compares what is shown with what was kept."""
        # The pointer is on nothing that lights up.
        self.browser.pointer({"type": "pointerMove", "x": 2, "y": 2, "duration": 0})
        # A new layout takes some frames, whatever they take.
        self.wait_frames()
        time.sleep(0.4)
        self.wait_frames()
        places = self.state()["places"]
        shown = self.shrunk(self.browser.picture())
        path = PICTURES / f"{name}.png"
        if self.keep:
            PICTURES.mkdir(exist_ok=True)
            path.write_bytes(shown)
            print(f"  {path.name} is kept")
            return
        changing = [places[name] for name in CHANGING if name in places]
        if "time" in places:
            changing.append([edge + room for edge, room in zip(places["time"], LEFT_OUT)])
        difference, x, y = self.difference(shown, path.read_bytes(), changing)
        print(f"  {path.name}: difference {difference:.1f} at {x}, {y}; at most {TOLERANCE}")
        if not difference <= TOLERANCE:
            seen = path.with_suffix(".seen.png")
            seen.write_bytes(shown)
            raise AssertionError(f"{name} looks otherwise: compare {seen} with {path}")

    def shrunk(self, picture):
        """A picture of a large screen is not kept whole."""
        data = base64.b64encode(picture).decode()
        return base64.b64decode(self.browser.run_later(SHRUNK, data, KEPT_WIDTH))

    def difference(self, shown, kept, changing):
        """The largest difference of a block, and where that is."""
        pictures = [base64.b64encode(picture).decode() for picture in (shown, kept)]
        return self.browser.run_later(DIFFERENCE, *pictures, changing, BLOCK)

    def choose(self, menu, item):
        """Chooses an item of a menu."""
        self.press(menu)
        self.wait(f"{menu} is open", lambda state: item in state["places"])
        # The menu moves to its place.
        time.sleep(0.3)
        self.press(item)
        self.wait(f"{menu} is closed", lambda state: item not in state["places"])

    def wait_frames(self):
        """Waits until a frame has seen what was done: the next one may have begun before that."""
        since = self.state()["frames"]
        self.wait("a frame has seen it", lambda state: state["frames"] >= since + 2)

    def drag(self, start, end, steps=12):
        """Drags something. A page takes a press and its release in one frame for no drag, however long that frame is."""
        self.browser.press(*start)
        self.wait_frames()
        self.browser.lead(start, end, steps)
        self.wait_frames()
        self.browser.release()

    def slide(self, name, part):
        """Drags a slider to a part of its way, from beside that: the leg does what it is led through. Its value stands right of it."""
        left, top, right, bottom = self.rect(name)
        middle = (top + bottom) / 2
        way = (left + 8, left + SLIDER_PART * (right - left))
        at = way[0] + part * (way[1] - way[0])
        self.drag((at - 6, middle), (at, middle))

    def focus(self, name):
        """Gives a control the keyboard's focus."""
        for _ in range(120):
            state = self.state()
            if state["focused"] == name:
                return
            self.browser.key(TAB)
            # The next key must not go past a control that a slow page has not shown yet.
            self.wait_frames()
        raise AssertionError(f"{name} has not got the focus")


SHRUNK = """
const [data, width, done] = arguments;
const picture = new Image();
picture.src = "data:image/png;base64," + data;
picture.decode().then(() => {
  if (picture.width <= width) { done(data); return; }
  const canvas = document.createElement("canvas");
  canvas.width = width; canvas.height = Math.round(width * picture.height / picture.width);
  const context = canvas.getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(picture, 0, 0, canvas.width, canvas.height);
  done(canvas.toDataURL("image/png").split(",")[1]);
});
"""

DIFFERENCE = """
const [a, b, changing, block, done] = arguments;
const pixels = async (data) => {
  const picture = new Image();
  picture.src = "data:image/png;base64," + data;
  await picture.decode();
  const canvas = document.createElement("canvas");
  canvas.width = picture.width; canvas.height = picture.height;
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  return context.getImageData(0, 0, picture.width, picture.height);
};
Promise.all([pixels(a), pixels(b)]).then(([p, q]) => {
  const [width, height] = [p.width, p.height];
  if (width !== q.width || height !== q.height) { done([255, width, height]); return; }
  const scale = width / window.innerWidth * window.leg_state().zoom;
  const changes = (x, y) => changing.some(([left, top, right, bottom]) =>
    x + block > left * scale - 4 && x < right * scale + 4 && y + block > top * scale - 4 && y < bottom * scale + 4);
  let largest = [0, 0, 0];
  for (let y = 0; y < height; y += block) {
    for (let x = 0; x < width; x += block) {
      if (changes(x, y)) { continue; }
      let sum = 0, count = 0;
      for (let v = y; v < Math.min(y + block, height); v++) {
        for (let u = x; u < Math.min(x + block, width); u++) {
          for (let colour = 0; colour < 3; colour++) {
            const at = 4 * (v * width + u) + colour;
            sum += Math.abs(p.data[at] - q.data[at]); count++;
          }
        }
      }
      if (sum / count > largest[0]) { largest = [sum / count, x, y]; }
    }
  }
  done(largest);
});
"""

FRAMES = """
const done = arguments[0];
const times = [];
const look = (now) => { times.push(now); times.length > 40 ? done(times) : requestAnimationFrame(look); };
requestAnimationFrame(look);
"""


@contextlib.contextmanager
def fast(page):
    """The leg's time goes eight times as fast within: for waits without a measured time."""
    page.choose("rate", "rate_8")
    yield
    page.choose("rate", "rate_1")


def look_until(look, holds):
    """What was seen until the last looks hold, by their medians: other programs keep the processor for a time only."""
    seen = []
    while len(seen) < MOST_LOOKS:
        seen.append(look())
        if len(seen) >= LOOKS and holds(*map(statistics.median, zip(*seen[-LOOKS:]))):
            return seen
    raise AssertionError(f"no {LOOKS} looks in a row hold by their medians: {seen}")


def check_speed(page):
    """Frame times, and whether the leg keeps up with the clock."""
    look = lambda: (*measured_speed(page), frame_part(page))
    look_until(look, lambda rate, frame_ms, part: REAL_TIME < rate < 1.1 and frame_ms <= FRAME_MS and part <= 1)


def frame_part(page):
    """What ticks, layout and triangles of a frame take of its time, without what paints them: above 1 a core falls behind."""
    cost = page.browser.run("return window.leg_frame_cost(arguments[0])", COST_FRAMES)
    print(
        f"  {cost['frames']} frames without painting (medians): {cost['ticks_ms']:.2f} ms ticks, {cost['layout_ms']:.2f} ms"
        f" layout, {cost['triangles_ms']:.2f} ms triangles: {100 * cost['part']:.0f} % of a core for 60 a second"
    )
    return cost["part"]


def measured_speed(page):
    """The leg's time by the clock's, and what the page takes for one of 60 frames in a second, ms."""
    before, began = page.state()["leg"]["time_s"], time.monotonic()
    times = page.browser.run_later(FRAMES)
    spans = [b - a for a, b in zip(times, times[1:])]
    time.sleep(1.0)
    leg_s = page.state()["leg"]["time_s"] - before
    clock_s = time.monotonic() - began
    rate, state = leg_s / clock_s, page.state()
    work, drawn = state["work"], state["frame_ms"]
    # A frame that is drawn slowly has more ticks to make up for than one of 60 in a second.
    ticks_ms = work["leg_median_ms"] * min(1.0, FRAME_MS / statistics.median(spans))
    frame_ms = work["median_ms"] - work["leg_median_ms"] + ticks_ms
    print(
        f"  frames: {statistics.median(spans):.1f} ms apart (median), {max(spans):.1f} at most; the page itself takes"
        f" {work['median_ms']:.1f} ms (median), {work['most_ms']:.1f} at most, {work['leg_median_ms']:.1f} of it for the"
        f" leg's ticks; {drawn:.1f} ms with what it hands to the graphics; {frame_ms:.1f} ms of 60 frames a second;"
        f" leg's time / clock {rate:.3f}"
    )
    return rate, frame_ms


def check_bits(page):
    """The firmware decides in the browser what it decides elsewhere, bit for bit."""
    rows = GOLDEN_BITS.read_text().splitlines()
    for name in ("cost", "payload", "fault_tension_jump"):
        (expected,) = [row for row in rows if row.startswith(f"{name} ")]
        row = page.browser.run("return window.leg_bits(arguments[0])", name)
        assert row == expected, (row, expected)
        print(f"  {row}: the same bits")


def first_visit(page):
    """What somebody does who has never seen it: the three steps."""
    page.wait_leg("rests", lambda leg: leg["state"] == "active" and not leg["compensated"])
    # Nothing is left out of the time of a new leg, however busy the machine was meanwhile.
    start_again(page)
    time.sleep(1.0)
    page.picture("start")
    page.press("guide_payload")
    leg = page.wait_leg("sags", lambda leg: leg["payload_kg"] > 1.99 and leg["error_mm"] > 6.5)
    time.sleep(1.5)
    leg = page.state()["leg"]
    print(f"  2 kg: {leg['error_mm']:.2f} mm off its target")
    # What the page promises is 7 mm.
    assert 6.5 < leg["error_mm"] < 7.5, leg["error_mm"]
    page.picture("sagging")
    page.press("guide_compensation")
    leg = page.wait_leg("rises", lambda leg: leg["compensated"] and leg["error_mm"] < 0.3)
    print(f"  compensated: {leg['error_mm']:.2f} mm")
    time.sleep(1.0)
    page.picture("compensated")


def start_again(page):
    page.press("start_again")
    page.wait_leg("starts again", lambda leg: leg["payload_kg"] == 0 and leg["time_s"] < 3)


def drive(page):
    """Moves by dragging and by keys, and homes."""
    start_again(page)
    left, top, right, bottom = page.rect("workspace")
    middle, width = ((left + right) / 2, (top + bottom) / 2), right - left
    start = middle[0] + 0.36 * width, middle[1] - 0.2 * width
    page.drag(start, (middle[0] - 0.2 * width, middle[1]))
    leg = page.wait_leg("leans to the other side", lambda leg: abs(leg["azimuth_deg"] - 180) < 8)
    print(f"  dragged to azimuth {leg['azimuth_deg']:.1f}°, tilt {leg['tilt_deg']:.1f}°")
    before = page.wait_leg("arrives", lambda leg: leg["error_mm"] < 3)["target"]
    # The drag has given the disc the focus. A press of an arrow key is 1°.
    for key, expected in ((RIGHT, (1, 0)), (UP, (1, 1))):
        page.browser.key(key)
        wanted = [at + math.radians(step) for at, step in zip(before, expected)]
        near = lambda leg: all(abs(a - b) < 1e-4 for a, b in zip(leg["target"], wanted))
        page.wait_leg(f"goes to {wanted}", near)
    page.wait_leg("arrives", lambda leg: leg["error_mm"] < 3)
    page.press("disarm")
    page.wait_leg("is disarmed", lambda leg: leg["state"] == "disarmed")
    page.press("home")
    page.wait_leg("homes", lambda leg: leg["state"] == "homing")
    with fast(page):
        leg = page.wait_leg("hangs down", lambda leg: leg["state"] == "active" and leg["tilt_deg"] < 1, 40)
    print(f"  homed in the {leg['time_s']:.1f}th second")


def stops(page):
    """Stops by a key, whatever has the focus: the key does nothing else."""

    def stopped(key, what):
        page.browser.key(key)
        page.wait_leg(f"is stopped: {what}", lambda leg: leg["state"] == "held")
        time.sleep(0.3)
        print(f"  stopped: {what}")

    def go_on():
        page.press("clear")
        page.wait_leg("goes on", lambda leg: leg["state"] == "active")

    start_again(page)
    page.focus("guide_payload")
    stopped(" ", "space, a button in focus")
    assert page.state()["leg"]["payload_kg"] == 0
    go_on()
    page.focus("guide_compensation")
    stopped(ESCAPE, "Escape, a button in focus")
    assert not page.state()["leg"]["compensated"]
    go_on()
    page.press("rate")
    page.wait("the menu is open", lambda state: "rate_0" in state["places"])
    stopped(ESCAPE, "Escape, a menu open")
    assert "rate_0" in page.state()["places"]
    page.press("rate")
    page.wait("the menu is closed", lambda state: "rate_0" not in state["places"])
    go_on()
    page.press("signals")
    page.wait("the menu is open", lambda state: "search" in state["places"])
    time.sleep(0.3)
    page.press("search")
    page.wait("the text is in focus", lambda state: state["focused"] == "search")
    stopped(" ", "space, a text field in focus")
    assert page.state()["focused"] == "search"
    page.press("signals")
    page.wait("the menu is closed", lambda state: "search" not in state["places"])
    go_on()
    page.press("stop")
    page.wait_leg("is stopped by the button", lambda leg: leg["state"] == "held")


def measured_rate(page):
    """The rate of the leg's time by the clock, without and with what a slow page leaves out."""

    def times_s():
        page.wait_frames()
        leg = page.state()["leg"]
        return leg["time_s"], leg["left_out_s"], time.monotonic()

    before_s = times_s()
    time.sleep(RATE_S)
    leg_s, left_out_s, clock_s = (after_s - at_s for at_s, after_s in zip(before_s, times_s()))
    return leg_s / clock_s, (leg_s + left_out_s) / clock_s


def rates(page):
    """Lets time go faster and slower, stops it, and drags the target meanwhile."""
    start_again(page)
    for name, nominal in (("rate_8", 8.0), ("rate_tenth", 0.1)):
        page.choose("rate", name)
        right = lambda rate, whole: rate > SLOW_PART * nominal and abs(whole / nominal - 1) < RATE_PART
        rate, whole = look_until(lambda: measured_rate(page), right)[-1]
        print(f"  {name}: leg's time / clock {rate:.3f}, {whole:.3f} with what is left out")
    page.choose("rate", "rate_0")
    before = page.wait_leg("stands still", lambda leg: leg["rate"] == 0)["time_s"]
    left, top, right, bottom = page.rect("workspace")
    middle, width = ((left + right) / 2, (top + bottom) / 2), right - left
    way = (middle[0] + 0.3 * width, middle[1]), (middle[0] - 0.2 * width, middle[1])
    page.drag(*way, steps=40)
    leg = page.wait_leg("shows the target", lambda leg: leg["target"][0] < -0.2)
    assert leg["time_s"] == before, (leg["time_s"], before)
    page.choose("rate", "rate_1")
    leg = page.wait_leg("goes there", lambda leg: abs(leg["azimuth_deg"] - 180) < 5)
    assert leg["refusal"] is None, leg["refusal"]


def sliders(page):
    """Payload, pretension and stiffness by their sliders."""
    start_again(page)
    page.slide("payload", 0.5)
    page.wait_leg("carries", lambda leg: leg["payload_kg"] > 0.3)
    page.slide("pretension", 0.7)
    leg = page.wait_leg("is pretensioned", lambda leg: leg["pretension_n"] > 80)
    print(f"  pretension {leg['pretension_n']:.1f} N")
    before = leg["stiffness_nm_per_rad"]
    page.slide("stiffness", 0.1)
    leg = page.wait_leg("is softer", lambda leg: leg["stiffness_nm_per_rad"] < before - 5)
    print(f"  stiffness {before:.1f}, then {leg['stiffness_nm_per_rad']:.1f} N·m/rad")
    assert leg["refusal"] is None, leg["refusal"]


def maps(page):
    """Every map, and none."""
    start_again(page)
    for name in ("sag", "stiffness", "margin"):
        page.choose("map", f"map_{name}")
        page.wait(f"the map of the {name}", lambda state: "map_key" in state["places"])
    page.picture("map")
    page.choose("map", "map_none")
    page.wait("no map", lambda state: "map_key" not in state["places"])


def pushes(page):
    """Pushes to each side, while time stands still, and lets the last push end."""
    page.choose("rate", "rate_0")
    for azimuth_deg in (0, 90, 180, 270):
        page.press(f"push_{azimuth_deg}")
        page.wait_leg(f"is pushed to {azimuth_deg}°", lambda leg: leg["push_deg"] == azimuth_deg)
    before = page.state()["leg"]["error_mm"]
    page.choose("rate", "rate_hundredth")
    page.wait_leg("yields", lambda leg: abs(leg["error_mm"] - before) > 0.5)
    page.choose("rate", "rate_1")
    page.wait_leg("is not pushed", lambda leg: leg["push_deg"] is None)


def breaks(page):
    """Cuts a tendon, reads the fault, and clears it."""
    start_again(page)
    page.press("cut_1")
    leg = page.wait_leg("is held", lambda leg: leg["state"] == "held" and leg["faults"])
    print(f"  faults: {', '.join(leg['faults'])}")
    assert "jump of a tension" in leg["faults"], leg["faults"]
    spoken = "return document.getElementById('spoken').textContent"
    page.wait_leg("is told", lambda _: "jump of a tension" in page.browser.run(spoken))
    page.wait("its estimates are in doubt", lambda state: "doubt" in state["places"])
    # A leg with a cut tendon swings for ten seconds.
    with fast(page):
        page.wait_leg("has swung", lambda now: now["time_s"] > leg["time_s"] + 8)
    page.wait_for_rest()
    page.picture("cut")
    page.press("repair")
    # As the remedy says it.
    page.press("disarm")
    page.wait_leg("is disarmed", lambda leg: leg["state"] == "disarmed")
    page.press("clear")
    page.wait_leg("is cleared", lambda leg: not leg["faults"])
    page.press("home")
    with fast(page):
        leg = page.wait_leg("is homed", lambda leg: leg["state"] == "active" and leg["tilt_deg"] < 1, 40)
    assert not leg["faults"] and "doubt" not in page.state()["places"], leg["faults"]
    print("  repaired, disarmed, cleared and homed")


DROP = """
const [name, data, done] = arguments;
const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
const given = new DataTransfer();
given.items.add(new File([bytes], name));
const canvas = document.getElementById("leg");
for (const kind of ["dragover", "drop"]) {
  canvas.dispatchEvent(new DragEvent(kind, { dataTransfer: given, bubbles: true, cancelable: true }));
}
done(true);
"""

# The dialog is the browser's own, and no driver can press it: the choice is made in its place.
CHOOSE = """
const [name, text] = arguments;
HTMLInputElement.prototype.click = function () {
  const given = new DataTransfer();
  given.items.add(new File([text], name));
  this.files = given.files;
  this.dispatchEvent(new Event("change"));
};
"""

# What is saved is read from the link that the page presses.
SAVED = """
window.saved = [];
HTMLAnchorElement.prototype.click = function () {
  const name = this.download;
  fetch(this.href).then((answer) => answer.arrayBuffer()).then((buffer) => {
    const bytes = new Uint8Array(buffer);
    let letters = "";
    for (let at = 0; at < bytes.length; at += 4096) {
      letters += String.fromCharCode(...bytes.subarray(at, at + 4096));
    }
    window.saved.push([name, btoa(letters)]);
  });
};
"""


def saved(page):
    """The name and the bytes of the one file that was saved since the links are watched."""
    until = time.monotonic() + WAIT_S
    while not (found := page.browser.run("return window.saved")):
        assert time.monotonic() < until
        time.sleep(0.1)
    ((name, data),) = found
    return name, base64.b64decode(data)


def drop(page, name, data):
    page.browser.run_later(DROP, name, base64.b64encode(data).decode())


def noticed(page, words):
    state = page.wait(words, lambda state: words in (state["setup"]["notice"] or ""))
    return state["setup"]["details"]


def close_notice(page):
    page.press("notice_close")
    page.wait("the notice is closed", lambda state: state["setup"]["notice"] is None)


def rig_files(page):
    """Gives rig files: good ones become the leg, bad ones are refused with their place, and the leg stays."""
    start_again(page)
    good = (RIGS / "table1.toml").read_text().replace("leg_mm = 190", "leg_mm = 250")
    bad = good.replace("leg_mm = 250", "leg_m = 0.25")
    line = 1 + bad.splitlines().index("leg_m = 0.25")
    drop(page, "longer.toml", good.encode())
    noticed(page, "longer.toml")
    leg = page.wait_leg("is longer", lambda leg: abs(leg["tip_mm"] - 279) < 0.1 and leg["state"] == "active")
    close_notice(page)
    page.picture("longer")
    for name, data, expected in (
        ("bad.toml", bad.encode(), f"bad.toml:{line}:1"),
        ("huge.toml", b"#" * (1024 * 1024 + 1), "larger than 1 MiB"),
        ("picture.png", (PICTURES / "phone.png").read_bytes(), "no text"),
    ):
        drop(page, name, data)
        details = noticed(page, name)
        assert expected in details and "help: " in details, details
        page.wait("the notice is shown", lambda state: "notice" in state["places"])
        if name == "bad.toml":
            assert "leg_m = 0.25" in details and "unknown key" in details, details
            page.picture("refused")
        close_notice(page)
        now = page.state()["leg"]
        assert now["rig"] == "longer.toml" and now["time_s"] > leg["time_s"], now
        print(f"  {name}: {details.splitlines()[0]}")
    page.press("setup")
    page.press("setup_rig")
    page.press("rig_spherical")
    page.wait_leg("is on a ball joint", lambda leg: leg["rig"] == "spherical.toml" and leg["state"] == "active")
    page.browser.run(CHOOSE, "chosen.toml", good)
    page.press("rig_open")
    page.wait_leg("is the chosen one", lambda leg: leg["rig"] == "chosen.toml")
    close_notice(page)
    page.picture("rigs")
    page.press("rig_table1")
    page.wait_leg("is the paper's", lambda leg: leg["rig"] == "table1.toml")
    close_notice(page)
    page.press("setup")


def type_value(page, name, text):
    page.press(name)
    page.wait(f"{name} is in focus", lambda state: state["focused"] == name)
    page.browser.type_over(text)
    time.sleep(0.4)


def settings(page):
    """Edits settings: refused with the reason, marked, taken back, saved, and given to the leg."""
    page.press("setup")
    page.wait("there are pages", lambda state: "setup_settings" in state["places"])
    page.press("setup_settings")
    page.wait("there is a search", lambda state: "settings_search" in state["places"])
    type_value(page, "settings_search", "jump")
    key = "value_control.limits.jump_n"
    page.wait("it is found", lambda state: key in state["places"])
    type_value(page, key, "1e6")
    state = page.wait("it is refused", lambda state: state["setup"]["refused"])
    assert "`jump_n` is outside" in state["setup"]["refused"], state["setup"]
    print(f"  {state['setup']['refused']}")
    type_value(page, key, "40")
    page.wait("it is taken", lambda state: state["setup"]["changed"] == ["control.limits.jump_n"])
    page.picture("settings")
    page.press("settings_undo")
    page.wait("it is taken back", lambda state: not state["setup"]["changed"])
    page.press("settings_redo")
    type_value(page, "settings_search", "leg_mm")
    page.wait("it is found", lambda state: "value_geometry.leg_mm" in state["places"])
    type_value(page, "value_geometry.leg_mm", "210")
    page.wait("both are changed", lambda state: len(state["setup"]["changed"]) == 2)
    page.browser.run(SAVED)
    page.press("settings_save")
    name, data = saved(page)
    text = data.decode()
    assert name == "table1.toml" and "leg_mm = 210" in text and "jump_n = 40" in text, name
    # Comments stay.
    assert text.startswith((RIGS / "table1.toml").read_text()[:200])
    close_notice(page)
    page.press("settings_apply")
    page.wait_leg("is so", lambda leg: abs(leg["tip_mm"] - 239) < 0.1 and leg["state"] == "active")
    close_notice(page)
    page.press("settings_all")
    page.press("settings_apply")
    page.wait_leg("is as before", lambda leg: abs(leg["tip_mm"] - 219) < 0.1)
    close_notice(page)
    page.press("setup")
    page.wait("the leg is shown", lambda state: "leg" in state["places"])


def steps(page):
    """Rehearses the calibrations on the simulated leg: a load cell, a motor, the zero."""
    start_again(page)
    page.press("setup")
    page.press("setup_steps")
    page.wait("there are guides", lambda state: "guide_cells" in state["places"])
    page.press("steps_disarm")
    page.wait_leg("is disarmed", lambda leg: leg["state"] == "disarmed")
    page.press("cell_2")
    page.press("cells_start")
    for _ in range(4):
        page.wait("a weight is to be hung", lambda state: "cells_read" in state["places"])
        if _ == 2:
            page.picture("cells")
        page.press("cells_read")
        page.wait("it is read now", lambda state: "cells_read" not in state["places"])
        # A reading a frame, a hundred of them.
        page.wait("it is read", lambda state: "cells_progress" not in state["places"], READ_S)
    page.wait_for("cells_result")
    page.press("cells_take")
    keys = ["calibration.cell_n_per_code", "calibration.cell_zero_code"]
    page.wait("the settings have it", lambda state: set(state["setup"]["changed"]) <= set(keys) and state["setup"]["changed"])
    print(f"  cell 2: {', '.join(page.state()['setup']['changed'])}")
    page.press("guide_turns")
    page.wait("there is a start", lambda state: "turns_start" in state["places"])
    page.press("turns_start")
    for motor in (1, 2, 3):
        page.wait("a motor is to be turned", lambda state: "turns_turned" in state["places"])
        page.press("turns_turned")
        page.wait("it is turned now", lambda state: "turns_turned" not in state["places"])
        page.wait("it is turned", lambda state: f"turn_{motor}" in state["places"], 30)
    page.wait("there is a result", lambda state: "turns_take" in state["places"])
    page.press("guide_motor")
    page.wait("there is a motor", lambda state: "jog_start" in state["places"])
    page.press("motor_3")
    page.press("jog_start")
    page.wait("there is a result", lambda state: "jog_result" in state["places"], 30)
    page.picture("motor")
    page.press("guide_zero")
    page.wait("there is a start", lambda state: "zero_start" in state["places"])
    page.press("zero_start")
    page.wait_leg("homes", lambda leg: leg["state"] == "homing")
    taut = lambda leg: leg["state"] == "active" and leg["tilt_deg"] < 1 and min(leg["tensions_n"]) > 69
    with fast(page):
        page.wait_leg("hangs down", taut, 60)
    page.picture("zero")
    page.press("setup")
    page.wait("the leg is shown", lambda state: "leg" in state["places"])


def tuning(page):
    """Measures a motor and the swing of the simulated leg: what will happen is said first, what was measured stands beside what is set."""
    start_again(page)
    page.press("setup")
    page.press("setup_steps")
    page.press("guide_tune")
    page.press("steps_disarm")
    page.wait_leg("is disarmed", lambda leg: leg["state"] == "disarmed")
    page.press("tune_motor_2")
    page.picture("tune")
    # However slow the page is, the stop comes at the begin of the measurement.
    page.choose("rate", "rate_tenth")
    page.press("tune_start")
    page.wait("it is measured", lambda state: "tune_seen" in state["places"])
    page.browser.key(" ")
    page.wait("it is ended by a stop", lambda state: "tune_failed" in state["places"])
    page.press("tune_again")
    page.choose("rate", "rate_1")
    page.press("tune_start")
    with fast(page):
        ended = page.wait("it has ended", lambda state: {"tune_result", "tune_failed"} & set(state["places"]), TUNED_S)
    assert "tune_failed" not in ended["places"], ended["setup"]["measure_failed"]
    page.picture("tuned")
    page.press("tune_take")
    changed = page.wait("the settings have it", lambda state: state["setup"]["changed"])["setup"]["changed"]
    assert "actuator.2.resistance_ohm" in changed, changed
    assert "tendon.measured.elongation_factor" in changed, changed
    print(f"  measured: {', '.join(changed)}")
    page.press("setup")
    page.wait("the leg is shown", lambda state: "leg" in state["places"])


def in_chart(page, name, part):
    left, top, right, bottom = page.rect(name)
    return left + part * (right - left), (top + bottom) / 2


def show_whole(page, name):
    """Shows a zoomed chart whole by a double click."""
    # With a click just before it would be one of three.
    time.sleep(1.5)
    page.browser.double_click(*in_chart(page, name, 0.5))
    page.wait(f"{name} is shown whole", lambda state: state["charts"]["zoomed_s"] is None)


def charts(page):
    """Reads charts: cursors, a trigger that catches a load, a spectrum, and the stiffness of the tip beside them."""
    start_again(page)
    controls = ("signals", "pause", "trigger", "cursors", "spectra", "record", "recording_open")
    before = {control: page.rect(control) for control in controls}
    page.press("trigger")
    page.wait("the menu is open", lambda state: "trigger_tip_error_mm_1" in state["places"])
    time.sleep(0.3)
    page.press("trigger_tip_error_mm_1")
    page.wait("there is a level", lambda state: "trigger_arm" in state["places"])
    time.sleep(0.3)
    page.press("trigger_level")
    time.sleep(0.3)
    page.browser.type_over("5")
    time.sleep(0.3)
    page.press("trigger_arm")
    page.wait("it waits", lambda state: state["charts"]["armed"])
    page.press("trigger")
    page.wait("the menu is closed", lambda state: "trigger_arm" not in state["places"])
    page.press("guide_payload")
    caught = page.wait("it has caught it", lambda state: state["charts"]["caught_s"] and state["charts"]["paused"])["charts"]
    since_s, until_s = caught["zoomed_s"]
    assert abs((since_s + until_s) / 2 - caught["caught_s"]) < 0.05, caught
    print(f"  the trigger has caught the load at {caught['caught_s']:.3f} s")
    page.press("cursors")
    a_s, b_s = page.wait("there are cursors", lambda state: state["charts"]["cursors_s"])["charts"]["cursors_s"]
    page.drag(in_chart(page, "tensions_n", 0.7), in_chart(page, "tensions_n", 0.85))
    state = page.wait("one is dragged", lambda state: state["charts"]["cursors_s"][1] > b_s)
    assert state["charts"]["cursors_s"][0] == a_s and "values_tensions_n" in state["places"], state["charts"]
    page.press("stiffness_ellipse")
    page.wait("the stiffness is drawn", lambda state: "stiffness_words" in state["places"])
    page.picture("charts")
    page.press("stiffness_ellipse")
    show_whole(page, "tensions_n")
    page.press("pause")
    page.wait("they go on", lambda state: not state["charts"]["paused"])
    page.press("spectra")
    peaks = page.wait("there are peaks", lambda state: "tensions_n" in state["charts"]["peaks"])["charts"]["peaks"]
    hz, amplitude_n = peaks["tensions_n"]
    assert 0 < hz <= 100 and amplitude_n > 0, peaks
    print(f"  the highest peak of a tension: {hz:.2f} Hz, {amplitude_n:.4f} N")
    page.press("spectra")
    same = lambda state: all(state["places"][control] == before[control] for control in controls)
    page.wait(f"nothing has moved from {before}", same)


def scrub(page, part):
    """Goes to a part of a recording by its slider."""
    left, top, right, bottom = page.rect("scrub")
    middle = (top + bottom) / 2
    page.drag((left + 0.5 * (right - left), middle), (left + part * (right - left), middle))


def narrow_player(page):
    """A recording on a phone held upright."""
    page.browser.prefer("light")
    page.browser.resize(360, 740)
    page.wait("it is narrow", lambda state: state["places"]["scrub"][2] <= 360)
    for control in ("back", "play", "play_rate", "recording_time", "scrub", "signals", "stop", "rate"):
        left, _, right, _ = page.rect(control)
        assert 0 <= left and right <= 360, (control, left, right)
    page.picture("phone_player")
    page.browser.resize(1280, 720)
    page.browser.prefer("dark")
    page.wait("it is wide", lambda state: state["places"]["scrub"][2] > 900)


def recordings(page):
    """Records, saves, opens again and scrubs: the leg moves along. What is broken is refused, what is cut off is not."""
    start_again(page)
    page.browser.run(SAVED)
    page.press("record")
    page.wait_leg("is recorded", lambda leg: (leg["recorded_s"] or 0) > 0.5)
    page.press("guide_payload")
    page.wait_leg("sags", lambda leg: leg["error_mm"] > 6.5)
    page.wait_for_rest()
    page.press("record")
    name, data = saved(page)
    assert name.startswith("leg-20") and name.endswith(".mcap") and data.startswith(b"\x89MCAP0"), name
    close_notice(page)
    start_again(page)
    # The name of a file that is made tells its time, which a picture would show.
    drop(page, "made.mcap", data)
    began = page.wait("it is opened", lambda state: state["player"])["player"]
    first_s, last_s = began["span_s"]
    print(f"  {name}: {len(data) / 1e6:.1f} MB, {last_s - first_s:.1f} s")
    assert began["finished"] and began["at_s"] == first_s and began["error_mm"] < 3, began
    still = ("back", "play", "play_rate", "scrub", "recording_time", "charts", "leg")
    for control in still:
        page.wait_for(control)
    before = page.state()["places"]
    scrub(page, 0.97)
    loaded = page.wait("it is loaded", lambda state: state["player"]["error_mm"] > 6.5)["player"]
    assert loaded["at_s"] > first_s + 0.9 * (last_s - first_s) and loaded["payload_kg"] > 1.99, loaded
    print(f"  at {loaded['at_s']:.2f} s: {loaded['error_mm']:.2f} mm off its target")
    page.picture("player")
    page.drag(in_chart(page, "tensions_n", 0.5), in_chart(page, "tensions_n", 0.7))
    page.wait("the chart is drawn aside", lambda state: state["charts"]["zoomed_s"])
    show_whole(page, "tip_error_mm")
    scrub(page, 0.02)
    page.wait("it is not loaded", lambda state: state["player"]["error_mm"] < 3)
    page.choose("play_rate", "play_16")
    page.press("play")
    page.wait("it has come to its end", lambda state: state["player"]["at_s"] == last_s)
    page.wait("it stands still", lambda state: not state["player"]["playing"])
    # Nothing moves when numbers change.
    same = lambda state: all(state["places"][control] == before[control] for control in still)
    page.wait(f"nothing has moved from {before}", same)
    narrow_player(page)
    page.press("back")
    page.wait("the leg is back", lambda state: not state["player"] and "workspace" in state["places"])
    drop(page, "cut.mcap", data[: len(data) // 2])
    cut = page.wait("it is opened", lambda state: state["player"])["player"]
    assert not cut["finished"] and "cut_off" in page.state()["places"], cut
    print(f"  cut off in its middle: to {cut['span_s'][1]:.2f} s")
    page.press("back")
    page.wait("the leg is back", lambda state: not state["player"])
    middle = len(data) // 2
    digit = data.index(b".", middle) + 1
    broken = data[:digit] + (b"2" if data[digit : digit + 1] == b"1" else b"1") + data[digit + 1 :]
    for given, content, expected in (
        ("broken.mcap", broken, "messages"),
        ("empty.mcap", b"", "no whole MCAP file"),
        ("foreign.mcap", (PICTURES / "phone.png").read_bytes(), "no whole MCAP file"),
    ):
        drop(page, given, content)
        details = noticed(page, given)
        assert expected in details and "help: " in details, details
        print(f"  {given}: {details.splitlines()[0]}")
        assert not page.state()["player"]
        page.wait("the notice is shown", lambda state: "notice_close" in state["places"])
        close_notice(page)


def looks(page):
    """The other sizes: a phone held upright, and a large screen; light. The page is new: nothing was changed in it."""
    page.open(page.address)
    page.browser.prefer("light")
    page.browser.resize(390, 844)
    page.wait("has tabs", lambda state: "tab_drive" in state["places"])
    page.picture("phone")
    page.press("tab_drive")
    page.wait("has the disc", lambda state: "workspace" in state["places"])
    page.picture("phone_drive")
    page.press("tab_setup")
    page.wait("has pages", lambda state: "setup_settings" in state["places"])
    page.press("setup_settings")
    page.wait("has the table", lambda state: "section" in state["places"])
    type_value(page, "settings_search", "leg_mm")
    page.wait("it is found", lambda state: "value_geometry.leg_mm" in state["places"])
    page.picture("phone_settings")
    page.press("tab_drive")
    page.browser.resize(3840, 2160)
    page.wait("is wide", lambda state: "tab_drive" not in state["places"])
    page.picture("large")


PARTS = (
    check_speed,
    check_bits,
    first_visit,
    drive,
    stops,
    rates,
    sliders,
    maps,
    pushes,
    breaks,
    charts,
    recordings,
    rig_files,
    settings,
    steps,
    tuning,
    looks,
)

# What is measured is alone; the rest is shared by browsers beside each other, which take about as long as each other: most of it waits
# for the leg's time.
MEASURED = (check_speed, check_bits, rates)
SHARED = (
    (first_visit, recordings, steps),
    (drive, breaks, rig_files, settings, stops, looks),
    (sliders, maps, pushes, charts, tuning),
)
assert {*MEASURED, *sum(SHARED, ())} == {*PARTS}


def serve(directory):
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    handler = functools.partial(Quiet, directory=str(directory))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_address[1]}/"


def open_page(page, file, directory):
    """Opens the page from disk and from a web server, and holds it to the time that it promises."""
    for address in (file.as_uri(), serve(directory)):
        took_s = look_until(lambda: (page.open(address),), lambda load_s: load_s <= LOAD_S)
        told = ", ".join(f"{load_s:.2f}" for load_s, in took_s)
        print(f"{address.split(':')[0]}: loaded in {told} s; the median of the last {LOOKS} is held to {LOAD_S:.0f} s")


def share(directory):
    """Does the shared parts in browsers beside each other, and tells of each when all of them have ended."""
    begun = []
    for parts in SHARED:
        command = [sys.executable, __file__, directory]
        for part in parts:
            command += ["--part", part.__name__]
        told = tempfile.TemporaryFile("w+")
        begun.append((subprocess.Popen(command, stdout=told, stderr=subprocess.STDOUT), told))
    codes = [process.wait() for process, _ in begun]
    for _, told in begun:
        told.seek(0)
        print(told.read(), end="")
    assert not any(codes), codes


def do(parts, keep, opened):
    """Does parts in a browser of their own."""
    with Browser(1280, 720) as browser:
        page = Page(browser, keep)
        browser.prefer("dark")
        opened(page)
        for part in parts:
            began = time.monotonic()
            print(part.__name__, flush=True)
            part(page)
            print(f"  {time.monotonic() - began:.1f} s")
        errors = [entry for entry in browser.log() if entry["level"] == "SEVERE"]
        assert not errors, errors


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=pathlib.Path)
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--beside", action="store_true", help="in browsers beside each other")
    parser.add_argument("--part", action="append", choices=[part.__name__ for part in PARTS], help="these parts alone")
    arguments = parser.parse_args()
    directory = arguments.directory
    file = (directory / "index.html").resolve()
    size = file.stat().st_size
    print(f"{size / 1e6:.2f} MB")
    assert size <= WIRE_BYTES, size
    chosen = arguments.part or []
    if not chosen:
        do(MEASURED, False, lambda page: open_page(page, file, directory))
    if arguments.beside and not chosen:
        share(directory)
    else:
        parts = [part for part in PARTS if part.__name__ in chosen or not chosen and part not in MEASURED]
        do(parts, arguments.keep, lambda page: page.open(serve(directory)))
    print("all of it holds")


if __name__ == "__main__":
    main()
