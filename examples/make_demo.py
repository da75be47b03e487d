"""Draws examples/demo.png: 500 x 500 terrain ids of the multiterrapath legend,
with blobs of costly terrain, a band across and two obstacles. Same bytes on
every machine; needs only the standard library.

usage: make_demo.py FILE.png
"""

import struct
import sys
import zlib

SIDE = 500
# Polygons in order of drawing: terrain id, corners.
POLYGONS = [
    (5, [(60, 40), (190, 20), (230, 120), (200, 260), (120, 330), (70, 200)]),
    (9, [(150, 180), (260, 150), (330, 230), (300, 340), (210, 380), (140, 300)]),
    (1, [(290, 20), (420, 50), (440, 150), (360, 210), (270, 140)]),
    (7, [(40, 350), (130, 370), (190, 440), (120, 480), (50, 450)]),
    (10, [(330, 260), (430, 230), (460, 330), (410, 420), (320, 400)]),
    (3, [(200, 400), (290, 390), (330, 470), (250, 490)]),
    (2, [(236, 0), (272, 0), (262, 150), (290, 300), (270, 499), (228, 499),
         (246, 300), (222, 150)]),
    (11, [(205, 60), (235, 60), (235, 215), (205, 215)]),
    (11, [(345, 180), (375, 180), (375, 300), (345, 300)]),
]


def inside(x, y, corners):
    """Even-odd rule at the middle of the cell, in integers."""
    odd = False
    x2, y2 = 2 * x + 1, 2 * y + 1
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):
        ax, ay, bx, by = 2 * ax, 2 * ay, 2 * bx, 2 * by
        if (ay > y2) != (by > y2):
            side = (x2 - ax) * (by - ay) - (bx - ax) * (y2 - ay)
            odd ^= (side < 0) == (by > ay)
    return odd


def chunk(kind, data):
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


rows = [bytearray(SIDE) for _ in range(SIDE)]
for terrain, corners in POLYGONS:
    for y in range(SIDE):
        for x in range(SIDE):
            if inside(x, y, corners):
                rows[y][x] = terrain
pixels = b"".join(b"\0" + bytes(row) for row in rows)
with open(sys.argv[1], "wb") as file:
    file.write(b"\x89PNG\r\n\x1a\n"
               + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 8, 0, 0, 0, 0))
               + chunk(b"IDAT", zlib.compress(pixels, 9)) + chunk(b"IEND", b""))
