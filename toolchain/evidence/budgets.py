"""What the figures may be at most. `budget` is checked; `target` and `stretch` are shown."""
import dataclasses

KIB = 1024

KINDS = {"everyday": "everyday, nothing limited", "limited": "limited, all axes at once", "change": "ramp or exchange", "anything": "anything"}
# machine: (what it is, budget of each kind of tick, target of each), instructions at most, accelerations limited
WORST = {
    "xyfz_compiled": ("XYFZ, compiled in", (350, 735, 820, 1460), (350, 620, 640, 1100)),
    "xyfz_loaded": ("XYFZ, loaded", (620, 1080, 1165, 1815), (580, 860, 880, 1350)),
    "xyb_a_compiled": ("X, Y, B against A, compiled in", (755, 1140, 1210, 1985), (715, 1000, 1020, 1700)),
    "xyb_a_loaded": ("X, Y, B against A, loaded", (1100, 1570, 1640, 2485), (1030, 1320, 1340, 1950)),
    "five_axis_compiled": ("five axes, compiled in", (830, 1255, 1295, 2300), (815, 1150, 1170, 1950)),
    "five_axis_loaded": ("five axes, loaded", (1200, 1695, 1740, 2810), (1120, 1460, 1480, 2250)),
    "five_axis_orienting": ("five axes, two orienting, loaded", (2680, 3495, 3540, 4630), (2450, 2950, 3000, 3600)),
    "five_axis_askew": ("five axes, every joint askew, loaded", (1560, 2050, 2100, 3170), (None, None, None, None)),
    "five_axis_fixed": ("the same with two fixed bodies that have errors", (1560, 2050, 2105, 3170), (1650, None, None, 2800)),
    "eight_axis": ("eight axes, loaded", (1750, 2230, 2295, 3960), (None, None, None, None)),
    # no bound on acceleration compiled in: OffsetLimiter<false>
    "xyfz_compiled_rate": ("XYFZ, compiled in, no acceleration", (335, 575, 590, 1180), (330, None, 345, 900)),
    "xyfz_loaded_rate": ("XYFZ, loaded, no acceleration", (600, 915, 935, 1550), (560, None, 580, 1150)),
    "xyb_a_compiled_rate": ("X, Y, B against A, compiled in, no acceleration", (725, 970, 990, 1720), (None, None, None, None)),
    "xyb_a_loaded_rate": ("X, Y, B against A, loaded, no acceleration", (1075, 1400, 1420, 2240), (None, None, None, None)),
    "five_axis_compiled_rate": ("five axes, compiled in, no acceleration", (795, 1060, 1080, 2025), (780, None, None, 1700)),
    "five_axis_loaded_rate": ("five axes, loaded, no acceleration", (1155, 1500, 1525, 2565), (1080, None, None, 2000)),
    "five_axis_orienting_rate": ("five axes, two orienting, loaded, no acceleration", (2620, 3160, 3200, 4185), (None, None, None, None)),
}
# (machine, kind of tick): what would be reached if everything went well
STRETCH = {("xyfz_compiled_rate", "everyday"): 250, ("xyfz_compiled_rate", "anything"): 500}
M4_OVER_M7 = 1.03  # at most, of every figure above
# machine whose plain tick is traced: (what it is, budget, target), cycles on a Cortex-M7 as llvm-mca estimates them
TRACED = {"xyfz_compiled": ("XYFZ, compiled in", 320, 275), "five_axis_loaded": ("five axes, loaded", 1270, None)}
# variant measured by kinds of event: what it is
TICKS = {
    "xyfz_compiled": "XYFZ, compiled in",
    "xyb_a_compiled": "X, Y, B against A, compiled in",
    "xyb_a_loaded": "X, Y, B against A, loaded",
    "five_axis_compiled": "five axes, compiled in",
    "five_axis_loaded": "five axes, loaded",
    "xyfz_loaded": "XYFZ, loaded",
    "xyz_second_order_compiled": "X, Y, Z, second order, compiled in",
}
# machine of the measured touches: what it is
TOUCHES = {"xyfz": "XYFZ", "xyb_a": "X, Y, B against A", "five_axis": "five axes"}
# board: (budget, target), instructions from the complete latch of an edge to its point. Points are made in double, which the
# M4F does in software.
TOUCH = {"m7": (2500, 1500)}
# way that corrections reach a drive: (what it is, budget), instructions from the last frame of a bus cycle to the last frame to a
# drive, three axes
LATENCY = {"offset": ("offsets 60B0h", 5000), "forwarded": ("forwarded targets", 6000)}
GRINDERS = ("m7",)   # boards with a node that watches strokes
STACK_OF_TICK = 256  # bytes
DEEPER = {"five_axis_orienting": "two orienting", "eight_axis": "eight axes"}  # without a budget of stack
NODE_FLASH = 104 * KIB  # 96 and what the ways of corrections to drives take, by part in docs/drives.md
PLAIN_FLASH = 84 * KIB  # of the node without a probe


@dataclasses.dataclass(frozen=True)
class Check:
    what: str
    measured: int
    budget: int
    target: int = None
    stretch: int = None

    def kept(self):
        return self.measured <= self.budget

    def line(self):
        marks = [f"{name} {value}" for name, value in (("budget", self.budget), ("target", self.target), ("stretch", self.stretch))
                 if value is not None]
        reached = "kept" if self.kept() else "broken"
        if self.target is not None and self.kept():
            reached = "target reached" if self.measured <= self.target else "budget kept, target missed"
        return f"{self.what}: {self.measured} ({', '.join(marks)}): {reached}"


def of_touches(board, touches):
    """`touches`: instructions by machine."""
    if board not in TOUCH:
        return []
    return [Check(f"{board}, touch, {name}, instructions", touches[machine]["point"], *TOUCH[board]) for machine, name in TOUCHES.items()]


def of_latency(board, ways):
    """`ways`: figures by way."""
    return [Check(f"{board}, last frame in to last frame out, {name}, instructions", ways[way]["max"], budget)
            for way, (name, budget) in LATENCY.items()]


def of_worst(board, machines):
    """`machines`: figures of each kind of tick by machine."""
    return [Check(f"{board}, {name}, {text}, instructions", machines[machine][kind]["max"], budget, target, STRETCH.get((machine, kind)))
            for machine, (name, budgets, targets) in WORST.items()
            for (kind, text), budget, target in zip(KINDS.items(), budgets, targets)]


def of_ratio(m7, m4):
    """Figures of each kind of tick by machine, on both boards."""
    return [Check(f"m4 beside m7, {name}, {text}, instructions", m4[machine][kind]["max"], int(M4_OVER_M7 * m7[machine][kind]["max"]))
            for machine, (name, _, _) in WORST.items() for kind, text in KINDS.items()]


def of_traced(machines):
    """`machines`: figures by machine."""
    return [Check(f"m7, {name}, plain tick, cycles estimated", machines[machine]["cycles"], budget, target)
            for machine, (name, budget, target) in TRACED.items()]


def of_stack(board, bounds):
    """`bounds`: static stack of the tick by machine."""
    return [Check(f"{board}, tick, {machine}, bytes of stack", bound, STACK_OF_TICK) for machine, bound in bounds.items() if machine not in DEEPER]
