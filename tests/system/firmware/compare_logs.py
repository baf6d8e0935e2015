"""Two logs of the same campaign: every frame of every cycle in motion the same.

    compare_logs.py FIRST SECOND

A log holds several machines, one after the other; each begins with the command to reset all nodes. How long
their nodes took to boot and to be configured is their own affair. From the first cycle in which an axis is told
to move, cycle by cycle, all frames have to be equal. The SYNC counter, which is in SYNC itself and in the node's
status, may be ahead in one of them by what the start took longer, the same number throughout.
"""

import sys

RESET_ALL = "000#8100"
NODE, CONTROLLER = 32, 127
OVERFLOW = 240  # of the SYNC counter
# Heartbeats, services and emergencies belong to no cycle.
PROCESS_DATA = range(0x180, 0x580)


def machines(path):
    """For every machine the cycles: SYNC counter, and the frames that follow it by identifier."""
    cycles = []
    for line in open(path):
        frame = line.split()[2]
        if frame == RESET_ALL:
            cycles = []
            yield cycles
        identifier, data = frame.split("#")
        identifier, data = int(identifier, 16), bytes.fromhex(data)
        if identifier == 0x080:
            cycles.append((data[0], {}))
        elif identifier in PROCESS_DATA and cycles:
            cycles[-1][1].setdefault(identifier, []).append(data)


def first_motion(cycles):
    """The first cycle in which the target (607Ah in RPDO1) of an axis is another than before."""
    before = {}
    for number, (_, frames) in enumerate(cycles):
        for identifier in (0x201, 0x202, 0x203):
            target = frames.get(identifier, [b""])[-1][2:6]
            if target and before.setdefault(identifier, target) != target:
                return number
    sys.exit("a machine that never moves")


def without_counter(identifier, data):
    """The node's status says in byte 5 to which SYNC it belongs."""
    return data[:5] + data[6:] if identifier == 0x180 + NODE else data


def compare(first, second):
    """Frames found equal; ends the program at the first difference."""
    first, second = first[first_motion(first):], second[first_motion(second):]
    if len(first) != len(second):
        sys.exit(f"one machine moves for {len(first)} cycles, the other for {len(second)}")
    lead = (first[0][0] - second[0][0]) % OVERFLOW
    frames = 0
    for number, ((a, sent_a), (b, sent_b)) in enumerate(zip(first, second)):
        where = f"cycle {number} of the motion, SYNC counters {a} and {b}"
        if (a - b) % OVERFLOW != lead:
            sys.exit(f"{where}: before, they were {lead} apart")
        if sent_a.keys() != sent_b.keys():
            sys.exit(f"{where}: other frames: {sorted(sent_a)} and {sorted(sent_b)}")
        for identifier, said in sent_a.items():
            said, other = ([without_counter(identifier, d) for d in s[identifier]] for s in (sent_a, sent_b))
            if said != other:
                sys.exit(f"{where}: {identifier:03X}h says {said} and {other}")
            frames += len(said)
    return len(first), frames, lead


def main():
    total = [0, 0, 0]
    leads = []
    first, second = list(machines(sys.argv[1])), list(machines(sys.argv[2]))
    if len(first) != len(second) or not first:
        sys.exit(f"{len(first)} machines and {len(second)}")
    for one, other in zip(first, second):
        cycles, frames, lead = compare(one, other)
        total[0] += cycles
        total[1] += frames
        leads.append(lead)
    print(f"{len(first)} machines, {total[0]} cycles in motion, {total[1]} frames equal, SYNC counters apart by {leads}")


main()
