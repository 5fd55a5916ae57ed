"""The pictures of a WebM file: their size, and when each is shown."""

from __future__ import annotations

# Elements of EBML that hold others: Segment, Cluster, Tracks, TrackEntry, Video, BlockGroup.
MASTERS = {0x18538067, 0x1F43B675, 0x1654AE6B, 0xAE, 0xE0, 0xA0}
WIDTH, HEIGHT, CLUSTER_TIME, BLOCKS = 0xB0, 0xBA, 0xE7, {0xA1, 0xA3}


def pictures(data):
    """Return the width, the height, and the times of the pictures of a video [ms].

    Recorders write segments and clusters of unknown size, so what is in them is read without it.
    Times are in units of 1 ms, the default of the format.
    """
    facts, times, start, at = {}, [], 0, 0
    while at < len(data):
        name, at = _number(data, at, marked=True)
        size, at = _number(data, at, marked=False)
        if name in MASTERS:
            continue
        body, at = data[at : at + size], at + size
        if name in (WIDTH, HEIGHT):
            facts[name] = int.from_bytes(body)
        elif name == CLUSTER_TIME:
            start = int.from_bytes(body)
        elif name in BLOCKS:
            _, after = _number(body, 0, marked=False)  # the track
            times.append(start + int.from_bytes(body[after : after + 2], signed=True))
    return facts[WIDTH], facts[HEIGHT], times


def _number(data, at, *, marked):
    """Return a number whose first byte has its length, and where it ends."""
    length = 9 - data[at].bit_length()
    value = int.from_bytes(data[at : at + length])
    return value if marked else value & ((1 << 7 * length) - 1), at + length
