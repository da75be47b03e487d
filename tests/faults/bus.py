"""Both buses as a test peer hears and speaks on them."""
import collections
import itertools
import random
import select
import socket
import struct
import time

import lcm_bus
import wire

SO_TIMESTAMPNS = 35
SO_RCVBUFFORCE = 33
SO_RXQ_OVFL = 40
TYPES = {"TERRA_" + name.upper(): name for name in wire.TYPES} | {"TERRA_LOG": "log_mark"}

Heard = collections.namedtuple("Heard", "ns channel data")


class Tap(lcm_bus.Peer):
    """A peer that knows when the kernel got each datagram, and how many it
    lost for want of room. Messages are dicts (wire.py)."""

    def __init__(self, port, buffer_bytes=64 << 20):
        super().__init__(port)
        self._socket.setsockopt(socket.SOL_SOCKET, SO_RCVBUFFORCE, buffer_bytes)
        self._socket.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, SO_RXQ_OVFL, 1)
        # Sends from a port of its own, so that it can be told from others.
        self._out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self._out.bind(("", 0))
        self.sending_port = self._out.getsockname()[1]
        self.overflown = 0

    @property
    def session(self):
        return self._session

    def say(self, channel, message):
        """Returns whether the network took it."""
        message = dict(message, utime=int(time.time() * 1e6), session=self._session)
        message["seq"] = self._sequences[channel] = self._sequences.get(channel, 0) + 1
        return self.say_raw(channel, wire.encode(TYPES[channel], message))

    def say_raw(self, channel, data):
        return self.send(struct.pack(">II", lcm_bus.SHORT, next(self._datagrams))
                  + channel.encode() + b"\0" + data)

    def send(self, datagram):
        """Returns whether the network took it."""
        try:
            self._out.sendto(datagram, self._address)
        except OSError:
            return False
        return True

    def datagrams(self, at_most=1_000):
        """Yields (nanoseconds since 1970, datagram, sender), without waiting."""
        for _ in range(at_most):
            try:
                datagram, extra, _, sender = self._socket.recvmsg(
                    65_536, 256, socket.MSG_DONTWAIT)
            except BlockingIOError:
                return
            ns = 0
            for level, kind, data in extra:
                if level == socket.SOL_SOCKET and kind == SO_TIMESTAMPNS:
                    seconds, rest = struct.unpack("qq", data)
                    ns = seconds * 1_000_000_000 + rest
                elif level == socket.SOL_SOCKET and kind == SO_RXQ_OVFL:
                    self.overflown = struct.unpack("I", data)[0]
            yield ns, datagram, sender

    def heard(self, at_most=1_000):
        """Yields what has arrived and has the form of a message."""
        for ns, datagram, sender in self.datagrams(at_most):
            try:
                message = self._message(datagram, sender)
            except (struct.error, UnicodeDecodeError):
                continue
            if message and message[0] in TYPES:
                yield Heard(ns, *message)


def decode(heard):
    """The message, or None when its bytes are none of its channel's type."""
    try:
        return wire.decode(TYPES[heard.channel], heard.data)
    except ValueError:
        return None


class Relay:
    """Carries datagrams between two ports, each way with its own misfortunes,
    all of it by the seed. Channels not named pass unharmed."""

    def __init__(self, ports, seed, lose=0.0, double=0.0, late=0.0, late_s=0.5, corrupt=0.0):
        self._random = random.Random(f"{seed} relay")
        self._chances = {"lost": lose, "doubled": double, "delayed": late, "corrupted": corrupt}
        self._late_s = late_s
        self._taps = [Tap(port) for port in ports]
        self._own = {tap.sending_port for tap in self._taps}
        self._due = []  # (when, number, tap, datagram)
        self._numbers = itertools.count()
        self.done = collections.Counter()

    def run(self, until):
        """Until it says so (asked every 20 ms)."""
        while not until():
            select.select(self._taps, [], [], 0.02)
            for tap, other in zip(self._taps, reversed(self._taps)):
                for _, datagram, sender in tap.datagrams():
                    if sender[1] not in self._own:
                        self._carry(datagram, other)
            now = time.monotonic()
            while self._due and self._due[0][0] <= now:
                _, _, tap, datagram = self._due.pop(0)
                tap.send(datagram)

    def _carry(self, datagram, tap):
        happens = {name for name, chance in self._chances.items()
                   if self._random.random() < chance}
        self.done.update(happens)
        self.done["carried"] += 1
        if "lost" in happens:
            self.done["lost " + datagram[8:].partition(b"\0")[0].decode("ascii", "replace")] += 1
            return
        if "corrupted" in happens:
            damaged = bytearray(datagram)
            damaged[self._random.randrange(8, len(damaged))] ^= 1 << self._random.randrange(8)
            datagram = bytes(damaged)
        for _ in range(1 + ("doubled" in happens)):
            if "delayed" in happens:
                wait = self._random.uniform(0, self._late_s)
                self._due.append((time.monotonic() + wait, next(self._numbers), tap, datagram))
                self._due.sort()
            else:
                tap.send(datagram)
