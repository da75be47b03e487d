"""LCM messages, read from the .lcm files alone.

Independent of the C++ code and of lcm-gen: a second opinion on what is on the
wire. Any bytes may be given to decode(); what is no whole message of
its type raises ValueError.
"""
import pathlib
import re
import struct

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "lcmtypes"
NUMBERS = {"int8_t": "b", "byte": "B", "int16_t": "h", "int32_t": "i",
           "int64_t": "q", "double": "d"}
MASK = (1 << 64) - 1


def _read_type(path):
    """[(kind, name, count field or None)] in the order of the wire."""
    text = re.sub(r"//.*", "", path.read_text())
    text = re.sub(r"const [^;]*;", "", text)
    body = text[text.index("{") + 1:text.rindex("}")]
    return [(kind, name, count or None) for kind, name, count in
            re.findall(r"(\w+)\s+(\w+)(?:\[(\w+)\])?\s*;", body)]


def _signed(value):
    return value - (1 << 64) if value >> 63 else value


def _mix(value, byte):
    value = _signed(value)
    return ((value << 8) ^ (value >> 55)) + byte & MASK


def _fingerprint(fields):
    value = 0x12345678

    def add(text):
        nonlocal value
        value = _mix(value, len(text))
        for byte in text.encode():
            value = _mix(value, byte)

    for kind, name, count in fields:
        add(name)
        add(kind)
        value = _mix(value, 1 if count else 0)
        if count:
            value = _mix(value, 1)  # A variable length.
            add(count)
    return (value << 1) + (value >> 63) & MASK


TYPES = {path.stem[:-2]: _read_type(path) for path in FOLDER.glob("*_t.lcm")}
FINGERPRINTS = {name: _fingerprint(fields) for name, fields in TYPES.items()}


class _Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, size):
        if size < 0 or self.at + size > len(self.data):
            raise ValueError("message ends too early")
        self.at += size
        return self.data[self.at - size:self.at]

    def one(self, kind):
        if kind == "string":
            size = struct.unpack(">i", self.take(4))[0]
            if size < 1:
                raise ValueError("bad string")
            return self.take(size)[:-1].decode("utf-8", "replace")
        code = NUMBERS[kind]
        return struct.unpack(">" + code, self.take(struct.calcsize(code)))[0]

    def many(self, kind, count):
        if count < 0 or count > len(self.data):
            raise ValueError("bad count")
        if kind == "string":
            return [self.one(kind) for _ in range(count)]
        if kind == "byte":
            return bytes(self.take(count))
        code = NUMBERS[kind]
        size = struct.calcsize(code) * count
        return list(struct.unpack(f">{count}{code}", self.take(size)))


def decode(name, data):
    """A dict of the fields."""
    reader = _Reader(data)
    if struct.unpack(">Q", reader.take(8))[0] != FINGERPRINTS[name]:
        raise ValueError("another type")
    message = {}
    for kind, field, count in TYPES[name]:
        message[field] = (reader.many(kind, message[count]) if count
                          else reader.one(kind))
    if reader.at != len(data):
        raise ValueError("bytes after the end")
    return message


def encode(name, message):
    """Missing fields are 0, empty."""
    out = [struct.pack(">Q", FINGERPRINTS[name])]

    def one(kind, value):
        if kind == "string":
            data = value.encode() + b"\0"
            out.append(struct.pack(">i", len(data)) + data)
        else:
            out.append(struct.pack(">" + NUMBERS[kind], value))

    for kind, field, count in TYPES[name]:
        empty = "" if kind == "string" else 0
        values = message.get(field, [] if count else empty)
        for value in values if count else [values]:
            one(kind, value)
    return b"".join(out)
