"""What the flash of an image is taken by: code and constants of each group, by the names of functions and of their sources."""
import re

# The tick itself, and what it calls out of line; everything else of a compensator is its background.
TICK = re.compile(r"_ZNK?7volcomp11Compensator.*E(4tick|7put_out|11put_out_all|15put_out_limited|17put_out_slow_path|16follow_slow_path|9all_known|"
                  r"16finish_slow_path|11take_sample|5place|16find_kept_excess|10take_turns|4idle|6report|11end_limited|12keep_places)[ERI]"
                  r"|detailL?14tick_slow_path|_ZNK?7volcomp13OffsetLimiter|detail7kCircle")
SOURCES = {
    "tables and folding": ("table_set", "image", "image_check", "machine_tables", "tables_view", "reversal", "thermal"),
    "machine": ("error_motion", "frame", "inverse", "machine_chain", "xyfz"),
    "probe and flanks": ("face_flank", "face_gear", "face_kernel", "face_relief", "face_touch", "nominal_chain", "probe_corrector",
                         "probe_rule", "touch_collector", "touch"),
    "strokes": ("helix_instances", "learning", "learning_choice", "spectral_line"),
}
LIBRARIES = {"node": "node", "canopen": "CANopen", "hal_mps2": "board", "hal_link": "board"}
# group: budget in the node of the Cortex-M7, bytes
BUDGETS = {"tick": 17152, "compensator, background": 6144, "tables and folding": 8448, "machine": 4864, "probe and flanks": 13056, "strokes": 0,
           "Eigen": 1536, "node": 34304, "CANopen": 9216, "texts": 2560, "board": 9728, "libgcc and libc": 1552, "rest": 2048}


def group_of(piece):
    source = piece.source.partition(".")[0]
    if ".str" in piece.section or source in ("reason_text", "status_text"):
        return "texts"
    if re.search(r"_ZNK?5Eigen", piece.section):
        return "Eigen"
    if TICK.search(piece.section):
        return "tick"
    if re.search(r"_ZNK?7volcomp11Compensator", piece.section):
        return "compensator, background"
    if piece.library in LIBRARIES:
        return LIBRARIES[piece.library]
    for group, sources in SOURCES.items():
        if piece.library == "comp" and source in sources:
            return group
    if piece.library == "comp":
        return "compensator, background" if "instances" in source else "rest"
    return "libgcc and libc" if re.match(r"_|lib_a-|c_functions$", source) else "board"


def measure(link_map, flash):
    """{group: bytes} of an image; `flash`: all it takes."""
    found = dict.fromkeys(BUDGETS, 0)
    for piece in link_map.pieces:
        if piece.section.startswith((".text", ".rodata", ".data", ".vectors")):
            found[group_of(piece)] += piece.size
    found["rest"] += flash - sum(found.values())
    return found
