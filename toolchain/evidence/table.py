"""The figures as Markdown, for docs/evidence.md and for reading."""
from budgets import LATENCY, NODE_FLASH, SPREAD, STACK_OF_TICK, TICKS, TOUCH, TOUCHES

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


def ticks(boards):
    body = []
    for variant, (name, budget, target, _) in TICKS.items():
        spans = [(boards[b]["ticks"][variant]["min"], boards[b]["ticks"][variant]["max"]) for b in BOARDS]
        body.append([name, *[judged(f"{number(least)} … {number(most)}", most, budget) for least, most in spans], limit(budget), limit(target)])
    spread = [max(t["max"] - t["min"] for v, t in boards[b]["ticks"].items() if TICKS[v][1]) for b in BOARDS]
    bound, seen = ([max(t[key] for t in boards[b]["ticks"].values()) for b in BOARDS] for key in ("stack_bound", "stack_painted"))
    body.append(["most − least of a machine with a budget", *[str(s) for s in spread], "–", limit(SPREAD)])
    body.append(["stack, bytes: proven / seen", *[judged(f"{b} / {s}", b, STACK_OF_TICK) for b, s in zip(bound, seen)],
                 limit(STACK_OF_TICK), "–"])
    return rows(["whole tick, instructions, least … most", *BOARDS.values(), "budget", "target"], body)


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
            ["node: stack, background and all interrupts at once, bytes: proven", *of("node", "stack", "bound"), "–", "–"],
            ["node: stack, bytes: seen", *of("node", "stack", "painted"), "–", "–"],
            ["node: stack, bytes: reserved", *of("node", "stack", "reserved"), "–", "–"],
            ["integrated servo loop: flash, bytes", *of("servo", "flash"), "–", "–"],
            ["integrated servo loop: RAM, bytes", *of("servo", "ram"), "–", "–"]]
    return rows(["images", *BOARDS.values(), "Cortex-A53", "budget"], body)


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
    counted = {f["kind"]: f["count"] for f in boards["m7"]["kinds"] if f["variant"] == "xyfz_compiled" and f["phase"] == "usual"
               and f["knots"] == max(k["knots"] for k in boards["m7"]["kinds"])}
    kernel = evidence["kernel_estimate"]
    seen = (f"{number(counted['any'])} ticks of ordinary operation each; XYFZ saw {number(counted['segment'])} ticks with a segment border, "
            f"{number(counted['reversal'])} reversals, {number(counted['clamp'])} clamps, {counted['swap']} exchanges of tables with "
            f"{number(counted['ramp'])} ticks of ramp.")
    text = [f"{seen} Bold: over its budget. {evidence['tables']}. {evidence['compiler']}, `{evidence['flags']}`; QEMU counts instructions, exactly, not cycles.",
            "", *ticks(boards), "", *latency(boards), "", *touches(boards), "", *strokes(boards), "", *services(boards), "", *images(evidence), "",
            f"llvm-mca estimates {kernel['cycles']} cycles on a Cortex-M7 for the {kernel['instructions']} instructions of the folded kernel, "
            "memory that answers at once assumed."]
    return "\n".join(text) + "\n"


def in_page(page, text):
    """The page with what stands between its two marks replaced; None where the marks are missing."""
    if BEGIN not in page or END not in page:
        return None
    head, rest = page.split(BEGIN, 1)
    return head + BEGIN + "\n\n" + text + "\n" + END + rest.split(END, 1)[1]
