"""What the figures may be at most. `budget` is checked; `target` and `stretch` are shown."""
import dataclasses

KIB = 1024

# variant of the tick: (what it is, budget, target, stretch), instructions of a whole tick
TICKS = {
    "xyfz_compiled": ("XYFZ, folded", 400, 310, 260),
    "xyb_a_compiled": ("X, Y, B against A, compiled in", 800, 640, None),
    "xyb_a_loaded": ("X, Y, B against A, loaded", 1150, 860, None),
    "five_axis_compiled": ("five axes, compiled in", 950, 750, None),
    "five_axis_loaded": ("five axes, loaded", 1350, 1030, None),
    "xyfz_loaded": ("XYFZ, folded, loaded", None, None, None),
    "xyz_second_order_compiled": ("X, Y, Z, second order, compiled in", None, None, None),
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
SPREAD = 40          # most − least of a variant with a budget: a target, since an interrupt is sized by its most
STACK_OF_TICK = 256  # bytes
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


def of_ticks(board, ticks, bounds):
    """`ticks`: least and most by variant; `bounds`: static stack of the tick by variant."""
    checks = []
    for variant, (name, budget, target, stretch) in TICKS.items():
        if budget is None:
            continue
        least, most = ticks[variant]
        checks.append(Check(f"{board}, {name}, instructions", most, budget, target, stretch))
        checks.append(Check(f"{board}, {name}, bytes of stack", bounds[variant], STACK_OF_TICK))
    return checks
