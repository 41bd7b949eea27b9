"""PNG files as these scripts write them."""
import struct
import zlib


def png(rows, palette=None):
    """The file of a picture, by rows from top to bottom: of bytes that are greys or, with a palette [(red, green,
    blue)], places in it."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3 if palette else 0, 0, 0, 0)  # 8 bits
    colours = chunk(b"PLTE", bytes(c for colour in palette for c in colour)) if palette else b""
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + colours +
            chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows), 9)) + chunk(b"IEND", b""))
