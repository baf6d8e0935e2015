"""What the figures may be at most. `budget` is checked; `target` and `stretch` are shown."""
import dataclasses

KIB = 1024

KINDS = {"everyday": "everyday, nothing limited", "limited": "limited, all axes at once", "change": "ramp or exchange", "anything": "anything"}
# machine: (what it is, budget of each kind of tick, target of each), instructions at most, accelerations limited
WORST = {
    "xyfz_compiled": ("XYFZ, compiled in", (360, 890, 1030, 1840), (350, 620, 640, 1100)),
    "xyfz_loaded": ("XYFZ, loaded", (620, 1150, 1290, 2180), (580, 860, 880, 1350)),
    "xyb_a_compiled": ("X, Y, B against A, compiled in", (760, 1280, 1430, 2380), (715, 1000, 1020, 1700)),
    "xyb_a_loaded": ("X, Y, B against A, loaded", (1100, 1620, 1780, 2890), (1030, 1320, 1340, 1950)),
    "five_axis_compiled": ("five axes, compiled in", (840, 1410, 1490, 2700), (815, 1150, 1170, 1950)),
    "five_axis_loaded": ("five axes, loaded", (1200, 1760, 1850, 3250), (1120, 1460, 1480, 2250)),
    "five_axis_orienting": ("five axes, two orienting, loaded", (2700, 3630, 3780, 5160), (2450, 2950, 3000, 3600)),
    "five_axis_askew": ("five axes, every joint askew, loaded", (1970, 2530, 2630, 4030), (None, None, None, None)),
    "five_axis_fixed": ("the same with two fixed bodies that have errors", (2250, 2810, 2910, 4310), (1650, None, None, 2800)),
    "eight_axis": ("eight axes, loaded", (1800, 2330, 2420, 4620), (None, None, None, None)),
    # no bound on acceleration compiled in: OffsetLimiter<false>
    "xyfz_compiled_rate": ("XYFZ, compiled in, no acceleration", (375, 765, 775, 1600), (330, None, 345, 900)),
    "xyfz_loaded_rate": ("XYFZ, loaded, no acceleration", (620, 995, 1020, 1960), (560, None, 580, 1150)),
    "five_axis_compiled_rate": ("five axes, compiled in, no acceleration", (795, 1190, 1205, 2530), (780, None, None, 1700)),
    "five_axis_loaded_rate": ("five axes, loaded, no acceleration", (1155, 1540, 1565, 3130), (1080, None, None, 2000)),
}
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
    return [Check(f"{board}, {name}, {text}, instructions", machines[machine][kind]["max"], budget, target)
            for machine, (name, budgets, targets) in WORST.items()
            for (kind, text), budget, target in zip(KINDS.items(), budgets, targets)]


def of_traced(machines):
    """`machines`: figures by machine."""
    return [Check(f"m7, {name}, plain tick, cycles estimated", machines[machine]["cycles"], budget, target)
            for machine, (name, budget, target) in TRACED.items()]


def of_stack(board, bounds):
    """`bounds`: static stack of the tick by machine."""
    return [Check(f"{board}, tick, {machine}, bytes of stack", bound, STACK_OF_TICK) for machine, bound in bounds.items() if machine not in DEEPER]
