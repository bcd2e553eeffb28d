"""A browser without a screen, driven by the WebDriver protocol: what a test of the page needs of it, and no more."""

import base64
import contextlib
import json
import socket
import subprocess
import time
import urllib.error
import urllib.request

START_S = 30


class Browser:
    """Chromium, through its driver."""

    def __init__(self, width, height, scale=1, dark=True):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.driver = subprocess.Popen(
            ["chromedriver", f"--port={port}"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.base = f"http://127.0.0.1:{port}"
        arguments = [
            "--headless=new",
            "--no-sandbox",
            "--disable-dev-shm-usage",
            # The processor draws, by the way that keeps the page waiting least: five times as many steps a second.
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--hide-scrollbars",
            f"--force-device-scale-factor={scale}",
        ]
        if dark:
            arguments.append("--blink-settings=preferredColorScheme=0")
        options = {"args": arguments}
        always = {
            "browserName": "chrome",
            "goog:chromeOptions": options,
            "goog:loggingPrefs": {"browser": "ALL"},
        }
        try:
            self._wait_for_driver()
            answer = self._call("POST", "/session", {"capabilities": {"alwaysMatch": always}})
            self.base += f"/session/{answer['sessionId']}"
            self.resize(width, height)
        except BaseException:
            self.driver.kill()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait()

    def _wait_for_driver(self):
        until = time.monotonic() + START_S
        while time.monotonic() < until:
            try:
                if self._call("GET", "/status")["ready"]:
                    return
            except OSError:
                pass
            time.sleep(0.1)
        raise RuntimeError("chromedriver does not start")

    def _call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        headers = {"Content-Type": "application/json"}
        request = urllib.request.Request(self.base + path, data, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()) from None

    def resize(self, width, height):
        """Makes the page, not the window around it, so large."""
        parameters = {"width": width, "height": height, "deviceScaleFactor": 0, "mobile": False}
        body = {"cmd": "Emulation.setDeviceMetricsOverride", "params": parameters}
        self._call("POST", "/goog/cdp/execute", body)

    def prefer(self, scheme):
        """Light or dark, as the system would say it."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        body = {"cmd": "Emulation.setEmulatedMedia", "params": {"features": features}}
        self._call("POST", "/goog/cdp/execute", body)

    @contextlib.contextmanager
    def covered(self):
        """The page is behind another one within."""
        page = self._call("GET", "/window")
        other = self._call("POST", "/window/new", {"type": "tab"})["handle"]
        self._call("POST", "/window", {"handle": other})
        yield
        self._call("DELETE", "/window")
        self._call("POST", "/window", {"handle": page})

    def open(self, address):
        self._call("POST", "/url", {"url": address})

    def run(self, script, *arguments):
        return self._call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def run_later(self, script, *arguments):
        """The script calls its last argument with the result."""
        return self._call("POST", "/execute/async", {"script": script, "args": list(arguments)})

    def log(self):
        return self._call("POST", "/se/log", {"type": "browser"})

    def picture(self):
        return base64.b64decode(self._call("GET", "/screenshot"))

    def pointer(self, *steps):
        actions = {"type": "pointer", "id": "mouse", "actions": list(steps)}
        self._call("POST", "/actions", {"actions": [actions]})

    def click(self, x, y):
        self.pointer(*move(x, y, 0), *DOWN, pause(60), *UP)

    def double_click(self, x, y):
        # Each step of the protocol waits for a frame: those of a slow page would be two clicks.
        self.pointer(*move(x, y, 0))
        self.run(DOUBLE_CLICK, x, y)

    def press(self, x, y):
        self.pointer(*move(x, y, 0), *DOWN)

    def lead(self, start, end, steps):
        """Moves the pointer along a line, in so many steps."""
        way = []
        for step in range(1, steps + 1):
            part = step / steps
            at = [a + part * (b - a) for a, b in zip(start, end)]
            way += move(*at, 40)
        self.pointer(*way)

    def release(self):
        self.pointer(*UP)

    def key(self, key):
        strokes = [{"type": "keyDown", "value": key}, pause(60), {"type": "keyUp", "value": key}]
        actions = {"type": "key", "id": "keyboard", "actions": strokes}
        self._call("POST", "/actions", {"actions": [actions]})

    def type_over(self, text):
        """Types a text in the place of what is in a field, and ends that by Enter."""
        strokes = [{"type": "keyDown", "value": CONTROL}, *stroke("a"), {"type": "keyUp", "value": CONTROL}]
        for letter in [*text, ENTER]:
            strokes += stroke(letter)
        actions = {"type": "key", "id": "keyboard", "actions": strokes}
        self._call("POST", "/actions", {"actions": [actions]})


CONTROL, ENTER = "\ue009", "\ue007"
DOWN = [{"type": "pointerDown", "button": 0}]
UP = [{"type": "pointerUp", "button": 0}]


# A double click, as a page hears it: handed over without the steps of the protocol.
DOUBLE_CLICK = """
const [x, y] = arguments;
const at = {bubbles: true, cancelable: true, clientX: x, clientY: y, button: 0, pointerId: 1, pointerType: "mouse"};
const shown = document.elementFromPoint(x, y);
for (const name of ["pointerdown", "pointerup", "pointerdown", "pointerup"]) {
  shown.dispatchEvent(new PointerEvent(name, {...at, buttons: name === "pointerdown" ? 1 : 0}));
}
"""


def stroke(key):
    # A frame of a busy machine may see no key that is shorter.
    return [{"type": "keyDown", "value": key}, pause(40), {"type": "keyUp", "value": key}, pause(40)]


def move(x, y, duration_ms):
    return [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": duration_ms}]


def pause(duration_ms):
    return {"type": "pause", "duration": duration_ms}
