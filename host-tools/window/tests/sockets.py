"""The other ends of a page's WebSocket: a stranger, a line that is cut, a server of another version."""

import base64
import contextlib
import hashlib
import json
import os
import select
import socket
import struct
import threading
import time
import urllib.parse

WAIT_S = 10

# What a server makes its answer of: RFC 6455.
MAGIC = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
TEXT, BINARY, CLOSE = 1, 2, 8


def ask(address, origin):
    """A line on which a page of some origin has asked for the leg, and the status of the answer."""
    parts = urllib.parse.urlsplit(address)
    head = [
        f"GET {parts.path} HTTP/1.1",
        f"Host: {parts.netloc}",
        "Upgrade: websocket",
        "Connection: Upgrade",
        f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}",
        "Sec-WebSocket-Version: 13",
        f"Origin: {origin}",
    ]
    line = socket.create_connection((parts.hostname, parts.port), WAIT_S)
    line.sendall(("\r\n".join(head) + "\r\n\r\n").encode())
    return line, int(read_head(line).split()[1])


def answer(address, origin):
    """The status of the answer to a page that asks for the leg."""
    line, status = ask(address, origin)
    line.close()
    return status


def read_head(line):
    head = b""
    while not head.endswith(b"\r\n\r\n"):
        byte = line.recv(1)
        if not byte:
            break
        head += byte
    return head.decode()


def exactly(line, count):
    data = b""
    while len(data) < count:
        more = line.recv(count - len(data))
        if not more:
            raise ConnectionError("ended")
        data += more
    return data


class Stranger:
    """A program that knows the address."""

    def __init__(self, address, origin):
        self.line, status = ask(address, origin)
        assert status == 101, status

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.line.close()

    def say(self, message):
        kind, data = (TEXT, message.encode()) if isinstance(message, str) else (BINARY, message)
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[at % 4] for at, byte in enumerate(data))
        self.line.sendall(bytes([0x80 | kind, 0x80 | len(data)]) + mask + masked)

    def message(self):
        """Kind and content of the next message."""
        first, length = exactly(self.line, 2)
        if length == 126:
            (length,) = struct.unpack(">H", exactly(self.line, 2))
        elif length == 127:
            (length,) = struct.unpack(">Q", exactly(self.line, 8))
        return first & 0x0F, exactly(self.line, length)

    def heard(self):
        """The next thing that is said of the connection."""
        while True:
            kind, data = self.message()
            if kind == TEXT:
                return json.loads(data)
            assert kind != CLOSE, data

    def ended(self):
        """Whether the other end ends it in time."""
        until = time.monotonic() + WAIT_S
        while time.monotonic() < until:
            try:
                if self.message()[0] == CLOSE:
                    return True
            except TimeoutError:
                return False
            except OSError:
                return True
        return False


class Server:
    """Takes lines on a free port, in threads."""

    def __enter__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.listen, daemon=True).start()
        return self

    def __exit__(self, *_):
        self.listener.close()

    def listen(self):
        with contextlib.suppress(OSError):
            while True:
                line, _ = self.listener.accept()
                threading.Thread(target=self.serve, args=(line,), daemon=True).start()


class Cutter(Server):
    """Passes everything on to an address, until it is cut."""

    def __init__(self, address):
        self.parts = urllib.parse.urlsplit(address)
        self.lines = []

    @property
    def url(self):
        return f"ws://127.0.0.1:{self.port}{self.parts.path}"

    def serve(self, line):
        other = socket.create_connection((self.parts.hostname, self.parts.port), WAIT_S)
        both = [line, other]
        self.lines += both
        with contextlib.suppress(OSError):
            while True:
                for ready in select.select(both, [], [])[0]:
                    data = ready.recv(65536)
                    if not data:
                        return
                    both[1 - both.index(ready)].sendall(data)

    def cut(self):
        # As when a cable is pulled: nobody says goodbye.
        for line in self.lines:
            with contextlib.suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)


class OldServer(Server):
    """Says of its leg that it speaks another protocol."""

    @property
    def url(self):
        return f"ws://127.0.0.1:{self.port}/old"

    def serve(self, line):
        head = read_head(line)
        (key,) = [row.split(": ")[1] for row in head.split("\r\n") if row.lower().startswith("sec-websocket-key")]
        accept = base64.b64encode(hashlib.sha1((key + MAGIC).encode()).digest()).decode()
        line.sendall(
            f"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode()
        )
        hello = json.dumps({"hello": {"schema": "0" * 16, "name": "sim", "rig": ""}}).encode()
        line.sendall(bytes([0x80 | TEXT, len(hello)]) + hello)
        with contextlib.suppress(OSError):
            while line.recv(1000):
                pass
