"""Points and times of Velodyne packets as velodyne-decoder (PyPI, 3.1.0) gives them, for crate/scans/tests/packets.rs.

    pip install velodyne-decoder==3.1.0
    python packets_reference.py > packets_reference.csv                    # of made-up packets
    python packets_reference.py FILE.pcap ... > captures_reference.csv     # of captures

Rows: product, return mode, x, y, z in metres, microseconds after the first packet's stamp; and the capture's name,
x, y, z in metres, microseconds after the hour. Both hold a sample of the returns.
"""

import struct
import sys
from pathlib import Path

import numpy
import velodyne_decoder

PACKETS = 24
SEQUENCE_US = 55.296
STAMP_US = 1_000_000
SAMPLE = 97
CAPTURE_SAMPLE = 499


def packets(product, mode):
    """Packets of a sensor that turns 4 degrees a block, or a pair of them: more than one turn in all."""
    returns = 2 if mode == 0x39 else 1
    packet_us = int(SEQUENCE_US * 24 / returns)
    for number in range(PACKETS):
        packet = bytearray()
        for block in range(12):
            group = (number * 12 + block) // returns
            packet += struct.pack("<HH", 0xEEFF, (35_900 + 400 * group) % 36_000)
            for beam in range(32):
                # Some beams have no return; every third one has the same return twice.
                seed = group * 32 + beam + (block % returns if beam % 3 else 0) * 7
                distance = 0 if seed % 5 == 0 else 250 + seed * 7919 % 1750
                packet += struct.pack("<HB", distance, beam)
        packet += struct.pack("<IBB", STAMP_US + number * packet_us, mode, product)
        yield bytes(packet)


def decode(stream):
    """All points of a stream of (stamp, packet), and their times on the sensor's clock in seconds."""
    decoder = velodyne_decoder.StreamDecoder(velodyne_decoder.Config())
    scans = [decoder.decode(stamp, packet) for stamp, packet in stream] + [decoder.finish()]
    for stamp, points in filter(None, scans):
        points = numpy.asarray(points, dtype=numpy.float64)
        yield points[:, :3], stamp.device + points[:, 4]


def made_up():
    for product in (0x22, 0x24):
        for mode in (0x37, 0x38, 0x39):
            stream = ((STAMP_US * 1e-6, packet) for packet in packets(product, mode))
            rows = [(*place, time) for places, times in decode(stream) for place, time in zip(places, times)]
            for x, y, z, time in rows[::SAMPLE]:
                print(f"{product},{mode},{x:.6f},{y:.6f},{z:.6f},{(time % 3600) * 1e6 - STAMP_US:.2f}")


def captures(files):
    for file in map(Path, files):
        config = velodyne_decoder.Config(timestamp_first_packet=True)
        rows = []
        for stamp, points in velodyne_decoder.read_pcap(str(file), config):
            points = numpy.asarray(points, dtype=numpy.float64)
            rows.extend(numpy.column_stack([points[:, :3], (stamp.device + points[:, 4]) % 3600]))
        for x, y, z, time in rows[::CAPTURE_SAMPLE]:
            print(f"{file.stem},{x:.6f},{y:.6f},{z:.6f},{time * 1e6:.2f}")


if len(sys.argv) > 1:
    captures(sys.argv[1:])
else:
    made_up()
