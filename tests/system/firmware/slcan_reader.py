"""What python-can hears from a node behind a serial line: its heartbeat, and the objects of its diagnostics.

    slcan_reader.py DEVICE
"""

import sys

import can

NODE = 32
PATIENCE_S = 30


def hear(bus, identifier):
    while (frame := bus.recv(timeout=PATIENCE_S)) is not None:
        if frame.arbitration_id == identifier:
            return frame
    sys.exit(f"{identifier:03X}h is not heard")


def upload(bus, index, sub):
    """Expedited SDO upload (CiA 301, 7.2.4.3.6)."""
    request = [0x40, index & 0xFF, index >> 8, sub, 0, 0, 0, 0]
    bus.send(can.Message(arbitration_id=0x600 + NODE, data=request, is_extended_id=False))
    return hear(bus, 0x580 + NODE).data.hex()


with can.Bus(interface="slcan", channel=sys.argv[1], bitrate=1_000_000) as bus:
    print("heartbeat", hear(bus, 0x700 + NODE).data.hex())
    print("product code", upload(bus, 0x1018, 2))
    print("state of the node", upload(bus, 0x2600, 1))
    print("cycles", upload(bus, 0x2600, 4))
