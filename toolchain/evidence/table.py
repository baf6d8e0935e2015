"""The figures as Markdown, for docs/evidence.md and for reading."""
import groups
from budgets import DEEPER, KINDS, LATENCY, NODE_FLASH, PLAIN_FLASH, STACK_OF_TICK, STRETCH, TOUCH, TOUCHES, TRACED, WORST

BEGIN, END = "<!-- evidence: made by toolchain/evidence.sh --write -->", "<!-- end of evidence -->"
BOARDS = {"m7": "Cortex-M7", "m4": "Cortex-M4F"}


def number(value):
    """12 345, as elsewhere in these pages."""
    return f"{value:,}".replace(",", " ")


def rows(head, body):
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    return lines + ["| " + " | ".join(line) + " |" for line in body]


def limit(value):
    return "–" if value is None else number(value)


def judged(text, value, budget):
    """Marked when it is over its budget."""
    return f"**{text}**" if budget is not None and value > budget else text


def worst(boards):
    """Least … most of every kind of tick of every machine. In brackets what would be reached if everything went well."""
    body = []
    for machine, (name, budgets, targets) in WORST.items():
        for (kind, text), budget, target in zip(KINDS.items(), budgets, targets):
            cells = []
            for board in BOARDS:
                found = boards[board]["worst"][machine][kind]
                cells.append(judged(f"{number(found['min'])} … {number(found['max'])}", found["max"], budget))
            beyond = STRETCH.get((machine, kind))
            wanted = limit(target) + (f" ({beyond})" if beyond else "")
            body.append([f"{name}: {text}", *cells, limit(budget), wanted])
    return rows(["whole tick, instructions", *BOARDS.values(), "budget", "target"], body)


def stack_and_spread(boards):
    second = [boards[b]["ticks"]["xyz_second_order_compiled"] for b in BOARDS]
    everyday = [[kinds["everyday"] for kinds in boards[b]["worst"].values()] for b in BOARDS]
    bound = [max(bytes for machine, bytes in boards[b]["stack_bounds"].items() if machine not in DEEPER) for b in BOARDS]
    seen = [max(t["stack_painted"] for t in boards[b]["ticks"].values()) for b in BOARDS]
    body = [["X, Y, Z, second order, compiled in, ordinary operation, instructions", *[f"{number(t['min'])} … {number(t['max'])}" for t in second], "–"],
            ["most − least of the everyday ticks of a machine", *[str(max(k["max"] - k["min"] for k in kinds)) for kinds in everyday], "–"],
            ["stack, bytes: proven / seen", *[judged(f"{b} / {s}", b, STACK_OF_TICK) for b, s in zip(bound, seen)], limit(STACK_OF_TICK)]]
    body += [[f"stack, {text}, bytes: proven", *[str(boards[b]["stack_bounds"][machine]) for b in BOARDS], "–"] for machine, text in DEEPER.items()]
    return rows(["whole tick", *BOARDS.values(), "budget"], body)


def traced(machines):
    """A plain tick as it is executed: what memory has to deliver, and what it takes when memory answers at once."""
    body = [[name, number(m["instructions"]), judged(number(m["cycles"]), m["cycles"], budget), limit(budget), limit(target),
             str(m["code_lines"]), str(m["data_lines"])]
            for machine, (name, budget, target) in TRACED.items() for m in [machines[machine]]]
    return rows(["plain tick, traced, Cortex-M7", "instructions", "cycles, estimated", "budget", "target", "lines of code, 32 bytes", "lines of data"],
                body)


def images(evidence):
    def of(image, *keys):
        cells = []
        for board in BOARDS:
            value = evidence["boards"][board]["products"][image]
            for key in keys:
                value = value[key]
            cells.append(number(value))
        return cells

    a53 = evidence["a53"]
    body = [["node: flash, bytes", *of("node", "flash"), number(a53["flash"]), limit(NODE_FLASH)],
            ["node: RAM, bytes", *of("node", "ram"), number(a53["ram"]), "–"],
            ["node without a probe: flash, bytes", *[number(evidence["boards"][b]["plain"]["flash"]) for b in BOARDS], "–", limit(PLAIN_FLASH)],
            ["node without a probe: RAM, bytes", *[number(evidence["boards"][b]["plain"]["ram"]) for b in BOARDS], "–", "–"],
            ["node: stack, background and all interrupts at once, bytes: proven", *of("node", "stack", "bound"), "–", "–"],
            ["node: stack, bytes: seen", *of("node", "stack", "painted"), "–", "–"],
            ["node: stack, bytes: reserved", *of("node", "stack", "reserved"), "–", "–"],
            ["integrated servo loop: flash, bytes", *of("servo", "flash"), "–", "–"],
            ["integrated servo loop: RAM, bytes", *of("servo", "ram"), "–", "–"]]
    return rows(["images", *BOARDS.values(), "Cortex-A53", "budget"], body)


def flash(boards):
    """The node's flash by group."""
    body = [[group, *[judged(number(boards[b]["groups"][group]), boards[b]["groups"][group], budget if b == "m7" else None) for b in BOARDS],
             number(budget)] for group, budget in groups.BUDGETS.items()]
    return rows(["flash of the node by group, bytes", *BOARDS.values(), "budget, M7"], body)


def latency(boards):
    body = [[f"three axes, {name}", *[f"{number(boards[b]['latency'][way]['min'])} … {number(boards[b]['latency'][way]['max'])}" for b in BOARDS],
             limit(budget)] for way, (name, budget) in LATENCY.items()]
    return rows(["from the last frame of a bus cycle to the last frame to a drive, instructions", *BOARDS.values(), "budget"], body)


def services(boards):
    def of(word, name, value):
        return [number(value(boards[b]["services"][word][name])) for b in BOARDS]

    def per_kib(key):
        return lambda image: round(image[key] * 1024 / image["bytes"])

    names = {"upload_expedited": "SDO upload, expedited", "download_expedited": "SDO download, expedited",
             "download_of_image": "SDO block download, one segment"}
    body = [[text + ", at most", *of("sdo", name, lambda cost: cost["max"])] for name, text in names.items()]
    for name, text in {"xyfz": "XYFZ", "five_axis": "five axes"}.items():
        body.append([f"checking an image, {text}, per KiB", *of("image", name, per_kib("check"))])
        body.append([f"folding its tables, {text}, per KiB", *of("image", name, per_kib("fold"))])
    return rows(["background, instructions", *BOARDS.values()], body)


def touches(boards):
    budget, target = TOUCH["m7"]
    body = []
    for machine, name in TOUCHES.items():
        cost = {b: boards[b]["touches"][machine] for b in BOARDS}
        body.append([f"{name}: from the complete latch to the point", judged(number(cost["m7"]["point"]), cost["m7"]["point"], budget),
                     number(cost["m4"]["point"]), limit(budget), limit(target)])
        body.append([f"{name}: reports of the drives, cycle with an edge / without", *[f"{number(cost[b]['collect'])} / {number(cost[b]['quiet'])}"
                                                                                     for b in BOARDS], "–", "–"])
    for key, text in {"judge": "face gear: judgement of a touch on a flank, background", "derive": "face gear: its constants, background"}.items():
        body.append([text, *[number(boards[b]["touches"]["flank"][key]) for b in BOARDS], "–", "–"])
    return rows(["touch, instructions, at most", *BOARDS.values(), "budget, M7", "target"], body)


def strokes(boards):
    """Rows of the boards that watch strokes; the others have no memory for it."""
    def of(part, text):
        return [text(boards[b]["strokes"][part]) if boards[b]["strokes"] else "–" for b in BOARDS]

    def span(what):
        return lambda cost: f"{number(cost[what + '_least'])} … {number(cost[what + '_most'])}"

    body = [["monitor of three axes and learned offset: share of a tick outside the face", *of("tick", span("away"))],
            ["the same in the face, four lines along Z, two in time", *of("tick", span("face"))],
            ["taking a pass into the sums, background, at most", *of("background", lambda cost: number(cost["collect"]))],
            ["one step of learning, three tables, background, at most", *of("background", lambda cost: number(cost["learn"]))],
            ["grinder's node: flash, bytes", *of("flash", number)],
            ["grinder's node: RAM, bytes", *of("ram", number)]]
    return rows(["strokes of a helical grinder, instructions", *BOARDS.values()], body)


def markdown(evidence):
    boards = evidence["boards"]
    kernel = evidence["kernel_estimate"]
    ticks = {kind: boards["m7"]["worst"]["xyfz_compiled"][kind]["count"] for kind in KINDS}
    seen = (f"{number(ticks['anything'])} ticks of each machine, searched for the most expensive one by chance and by plan, accelerations limited "
            f"and not; of XYFZ {number(ticks['everyday'])} everyday ones, {number(ticks['limited'])} limited, {number(ticks['change'])} of a ramp or an "
            "exchange; anything: besides these, axes lost, not homed, implausible, beyond their tables, all at once, settings changed, tables damaged.")
    text = [f"{seen} Bold: over its budget. {evidence['tables']}. {evidence['compiler']}, `{evidence['flags']}`; QEMU counts instructions, exactly, not cycles.",
            "", *worst(boards), "", *stack_and_spread(boards), "", *traced(evidence["traced"]), "", *latency(boards), "", *touches(boards), "", *strokes(boards), "", *services(boards), "", *images(evidence), "", *flash(boards), "",
            f"llvm-mca estimates {kernel['cycles']} cycles on a Cortex-M7 for the {kernel['instructions']} instructions of the folded kernel. "
            "Estimates assume memory that answers at once and branches taken as foreseen."]
    return "\n".join(text) + "\n"


def in_page(page, text):
    """The page with what stands between its two marks replaced; None where the marks are missing."""
    if BEGIN not in page or END not in page:
        return None
    head, rest = page.split(BEGIN, 1)
    return head + BEGIN + "\n\n" + text + "\n" + END + rest.split(END, 1)[1]
